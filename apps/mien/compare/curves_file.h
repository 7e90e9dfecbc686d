// What two files are compared by, whatever their format.
#pragma once

#include <mien/mien.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/animation/animation.h"

namespace mien::app {

struct HeadAngles {
  double pitch, yaw, roll;  // radians, as in mien_result
};

struct CurvesFrame {
  double t_ms = 0.0;
  std::optional<HeadAngles> head;                     // nothing: no face
  std::array<double, MIEN_CONTROL_COUNT> controls{};  // 0..1; NaN where not driven
};

using Curves = std::vector<CurvesFrame>;

// At least one frame, times that do not go back. Throws Failure(kExitNoInput) naming line and
// column. `name` is what the message calls the file.
Curves parse_curves(std::string_view text, const std::string& name,
                    const formats::ReadOptions& options = {});

// Also what lies beside a file of Live Link Face counts; what was taken for granted is printed,
// unless `quiet`. Throws Failure(kExitNoInput).
Curves read_curves(const std::string& path, bool quiet);

}  // namespace mien::app
