// Rows of the CSV file of landmarks; docs/cli.md describes the columns.
#pragma once

#include <cstdint>
#include <mien/mien.hpp>
#include <string>

namespace mien::app {

// With several faces, the file has a column face_id and one row per face and frame.
enum class Faces { kOne, kSeveral };

std::string landmark_header(Faces faces);
std::string landmark_row(std::int64_t frame, Faces faces, const Result& result);

}  // namespace mien::app
