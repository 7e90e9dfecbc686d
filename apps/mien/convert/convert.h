// Implements `mien convert`, which converts animations between formats and frame rates.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "apps/mien/outputs/animation_output.h"

namespace mien::app {

struct ConvertOptions {
  std::string input;     // "-": standard input
  std::string output;    // "-": standard output
  std::string from, to;  // format names; empty: selected by the files
  // Units of INPUT; default: from a file beside it, or detected.
  std::optional<animation::RotationUnit> from_rotation;
  std::optional<double> from_timecode_fps;
  std::optional<animation::LengthUnit> from_bvh_unit;
  animation::WriteOptions writing;
  std::string avatar;         // file into which a .glb bakes the animation; empty: none
  std::optional<double> fps;  // default: the timestamps of the frames
  std::optional<std::int64_t> face;
  bool quiet = false;
  bool json = false;  // print the report to standard error as JSON
};

// Throws Failure.
void convert(const ConvertOptions& options);

}  // namespace mien::app
