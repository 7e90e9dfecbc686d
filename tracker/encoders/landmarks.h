// The landmarks that encoders output; models/landmarks.json names them.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "tracker/geometry/crop.h"
#include "tracker/geometry/geometry.h"

namespace mien::tracker {

inline constexpr std::size_t kLandmarks = 175;
using Landmarks = std::array<Point, kLandmarks>;  // pixels of the upright scene

// Converts `xy` (x0, y0, x1, ...) from crop coordinates.
[[nodiscard]] inline Landmarks landmarks_in(const Crop& crop, std::span<const float> xy) {
  const Affine to_scene = crop_to_image(crop);
  Landmarks landmarks;
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    landmarks[i] = to_scene({xy[2 * i], xy[2 * i + 1]});
  }
  return landmarks;
}

}  // namespace mien::tracker
