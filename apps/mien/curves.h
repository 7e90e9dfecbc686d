// The two tables `mien track` writes; docs/cli.md describes their columns.
#pragma once

#include <mien/mien.hpp>

#include <cstdint>
#include <string>

namespace mien::app {

// Of one face, or of several: these have a column more, and a row for each face of a frame.
enum class Faces { kOne, kSeveral };

std::string curve_header(Faces faces);
std::string curve_row(std::int64_t frame, Faces faces, const Result& result);

std::string landmark_header(Faces faces);
std::string landmark_row(std::int64_t frame, Faces faces, const Result& result);

}  // namespace mien::app
