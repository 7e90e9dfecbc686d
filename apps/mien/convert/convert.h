// `mien convert`: animated faces from one format to another, and to another frame rate.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "apps/mien/outputs/animation_output.h"

namespace mien::app {

struct ConvertOptions {
  std::string input;     // "-": standard input
  std::string output;    // "-": standard output
  std::string from, to;  // names of formats; empty: as the file says
  // Of INPUT; none: as files beside it or its content say.
  std::optional<formats::RotationUnit> from_rotation;
  std::optional<double> from_timecode_fps;
  std::optional<formats::LengthUnit> from_bvh_unit;
  formats::WriteOptions writing;
  std::optional<double> fps;  // none: the frames' own times
  std::optional<std::int64_t> face;
  bool quiet = false;
  bool json = false;  // the report on standard error
};

// Throws Failure.
void convert(const ConvertOptions& options);

}  // namespace mien::app
