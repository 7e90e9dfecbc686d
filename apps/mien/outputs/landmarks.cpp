// Formats rows of landmarks.
#include "apps/mien/outputs/landmarks.h"

#include <array>

#include "apps/animation/csv_row.h"

namespace mien::app {
namespace {

using animation::CsvRow;

// Buffer for the longest row; each cell is a number or a short word.
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

}  // namespace

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
    for (const float coordinate : result.landmarks[i]) {
      result.has_face() ? row.add(coordinate) : row.add_empty();
    }
  }
  return std::string(row.finish());
}

}  // namespace mien::app
