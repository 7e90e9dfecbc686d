#include "apps/mien/curves.h"

#include "apps/mien/csv.h"

namespace mien::app {
namespace {

// Box, landmarks and pose mean something as long as there is a face.
template <class... Values>
void numbers_if(bool present, CsvRow& row, Values... values) {
  (..., (present ? row.number(values) : row.empty()));
}

}  // namespace

std::string curve_header() {
  CsvRow row;
  for (const char* name : {"frame", "t_ms", "status", "face_prob", "lod", "vad", "x", "y", "w", "h",
                           "pitch_rad", "yaw_rad", "roll_rad", "tx_m", "ty_m", "tz_m"}) {
    row.text(name);
  }
  for (int i = 0; i < mien_control_count(); ++i) {
    row.text(mien_control_name(i));
  }
  return row.finished();
}

std::string curve_row(std::int64_t frame, const Result& result) {
  CsvRow row;
  row.number(frame);
  row.number(static_cast<double>(result.pts_ns) * 1e-6);
  row.text(mien_face_status_name(result.status));
  row.number(result.face_probability);
  row.number(result.lod);
  row.number(result.voice_activity);
  const float* box = result.box;
  numbers_if(result.has_face(), row, box[0], box[1], box[2], box[3], result.pitch, result.yaw,
             result.roll, result.translation[0], result.translation[1], result.translation[2]);
  for (int i = 0; i < mien_control_count(); ++i) {
    numbers_if(result.supports(i), row, result.controls[i]);
  }
  return row.finished();
}

std::string landmark_header() {
  CsvRow row;
  row.text("frame");
  for (int i = 0; i < mien_landmark_count(); ++i) {
    row.text("x" + std::to_string(i));
    row.text("y" + std::to_string(i));
  }
  return row.finished();
}

std::string landmark_row(std::int64_t frame, const Result& result) {
  CsvRow row;
  row.number(frame);
  for (int i = 0; i < mien_landmark_count(); ++i) {
    numbers_if(result.has_face(), row, result.landmarks[i][0], result.landmarks[i][1]);
  }
  return row.finished();
}

}  // namespace mien::app
