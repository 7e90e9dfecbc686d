#include "apps/mien/curves.h"

#include <array>

#include "formats/csv_row.h"

namespace mien::app {
namespace {

using formats::CsvRow;

// Room for the longest row, that of the landmarks: each cell a number or a short word.
class Row : public CsvRow {
 public:
  Row() : CsvRow(room_) {}

 private:
  std::array<char, CsvRow::kMaxNumberBytes*(2 + 2 * MIEN_LANDMARK_COUNT)> room_;
};

void begin_header(CsvRow& row, Faces faces) {
  row.add(std::string_view("frame"));
  if (faces == Faces::kSeveral) {
    row.add(std::string_view("face_id"));
  }
}

void begin(CsvRow& row, std::int64_t frame, Faces faces, const Result& result) {
  row.add(frame);
  if (faces == Faces::kSeveral) {
    row.add(std::int64_t{result.face_id});
  }
}

// Box, landmarks and pose mean something as long as there is a face.
template <class... Values>
void add_if(bool present, CsvRow& row, Values... values) {
  (..., (present ? row.add(values) : row.add_empty()));
}

}  // namespace

std::string curve_header(Faces faces) {
  Row row;
  begin_header(row, faces);
  for (const char* name : {"t_ms", "status", "face_prob", "lod", "vad", "x", "y", "w", "h",
                           "pitch_rad", "yaw_rad", "roll_rad", "tx_m", "ty_m", "tz_m"}) {
    row.add(std::string_view(name));
  }
  for (int i = 0; i < mien_control_count(); ++i) {
    row.add(std::string_view(mien_control_name(i)));
  }
  return std::string(row.finish());
}

std::string curve_row(std::int64_t frame, Faces faces, const Result& result) {
  Row row;
  begin(row, frame, faces, result);
  row.add(static_cast<double>(result.pts_ns) * 1e-6);
  row.add(std::string_view(mien_face_status_name(result.status)));
  row.add(result.face_probability);
  row.add(std::int64_t{result.lod});
  row.add(result.voice_activity);
  const float* box = result.box;
  add_if(result.has_face(), row, box[0], box[1], box[2], box[3], result.pitch, result.yaw,
         result.roll, result.translation[0], result.translation[1], result.translation[2]);
  for (int i = 0; i < mien_control_count(); ++i) {
    add_if(result.supports(i), row, result.controls[i]);
  }
  return std::string(row.finish());
}

std::string landmark_header(Faces faces) {
  Row row;
  begin_header(row, faces);
  for (int i = 0; i < mien_landmark_count(); ++i) {
    for (const char* axis : {"x", "y"}) {
      row.add(std::string_view(std::string(axis).append(std::to_string(i))));
    }
  }
  return std::string(row.finish());
}

std::string landmark_row(std::int64_t frame, Faces faces, const Result& result) {
  Row row;
  begin(row, frame, faces, result);
  for (int i = 0; i < mien_landmark_count(); ++i) {
    add_if(result.has_face(), row, result.landmarks[i][0], result.landmarks[i][1]);
  }
  return std::string(row.finish());
}

}  // namespace mien::app
