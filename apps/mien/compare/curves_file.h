// Curves of an animation, for comparison.
#pragma once

#include <mien/mien.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/animation/animation.h"

namespace mien::app {

struct HeadAngles {
  double pitch, yaw, roll;  // radians, as in mien_result
};

struct CurvesFrame {
  double t_ms = 0.0;
  std::optional<HeadAngles> head;                     // empty without a face
  std::array<double, MIEN_CONTROL_COUNT> controls{};  // 0..1; NaN if the file does not have it
};

using Curves = std::vector<CurvesFrame>;

// Requires one to 216,000 frames and non-decreasing times. Throws Failure(kExitNoInput) with line
// and column. Messages refer to the file as `name`.
Curves parse_curves(std::string_view text, const std::string& name,
                    const animation::ReadOptions& options = {});

// Also reads the JSON file beside a Live Link Face file. Prints assumed units unless `quiet`.
// Throws Failure(kExitNoInput).
Curves read_curves(const std::string& path, bool quiet);

}  // namespace mien::app
