// The two tables `mien track` writes; docs/cli.md describes their columns.
#pragma once

#include <mien/mien.hpp>

#include <cstdint>
#include <string>

namespace mien::app {

std::string curve_header();
std::string curve_row(std::int64_t frame, const Result& result);

std::string landmark_header();
std::string landmark_row(std::int64_t frame, const Result& result);

}  // namespace mien::app
