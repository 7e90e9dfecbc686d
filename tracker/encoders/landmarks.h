// The landmarks that encoders output; models/landmarks.json names them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tracker/geometry/crop.h"
#include "tracker/geometry/geometry.h"

namespace mien::tracker {

inline constexpr std::size_t kLandmarks = 175;
using Landmarks = std::array<Point, kLandmarks>;  // pixels of the upright scene

// A range of landmarks with a common name.
struct LandmarkGroup {
  const char* name;
  std::int32_t first, count;
};

// In the order of mien_landmark_group; models/landmarks.json has the same names.
inline constexpr LandmarkGroup kLandmarkGroups[] = {
    {"right_eye_lower", 0, 9},     {"left_eye_lower", 9, 9},
    {"right_eye_upper", 18, 7},    {"left_eye_upper", 25, 7},
    {"right_iris", 32, 5},         {"left_iris", 37, 5},
    {"right_brow_upper", 42, 5},   {"left_brow_upper", 47, 5},
    {"right_brow_lower", 52, 5},   {"left_brow_lower", 57, 5},
    {"right_nose_side", 62, 8},    {"left_nose_side", 70, 8},
    {"right_cheek", 78, 5},        {"left_cheek", 83, 5},
    {"nose_bridge", 88, 8},        {"midline", 96, 3},
    {"lips_outer_upper", 99, 11},  {"lips_outer_lower", 110, 9},
    {"lips_inner_upper", 119, 11}, {"lips_inner_lower", 130, 9},
    {"face_oval", 139, 36},
};

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
