// `mien convert`: animated faces from one format to another, and to another frame rate.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "apps/mien/outputs/animation_output.h"

namespace mien::app {

struct ConvertOptions {
  std::string input;                                   // "-": standard input
  std::string output;                                  // "-": standard output
  std::string from, to;                                // names of formats; empty: as the file says
  std::optional<formats::RotationUnit> from_rotation;  // of Live Link Face; none: as the file
  std::optional<double> from_timecode_fps;             // beside it says, or its own defaults
  formats::WriteOptions writing;
  std::optional<double> fps;  // none: the frames' own times
  std::optional<std::int64_t> face;
  bool quiet = false;
  bool json = false;  // the report on standard error
};

// Throws Failure.
void convert(const ConvertOptions& options);

}  // namespace mien::app
