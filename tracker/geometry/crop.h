// The crop of a face: a rotated square of the image, placed by the face's landmarks.
#pragma once

#include <span>

#include "tracker/geometry/geometry.h"

namespace mien::tracker {

// Crop coordinates run over 0..1 in x (right) and y (down). An image point is
//   p_image = side * Rot(roll) * (p_crop - 0.5) + center.
struct Crop {
  Point center;       // pixels of the image
  float side = 0.0f;  // pixels
  float roll = 0.0f;  // radians, from x towards y: clockwise on the screen
};

[[nodiscard]] Affine crop_to_image(const Crop& crop);

// Fits the crop whose similarity (without reflection) maps the template `shape` [n] (crop
// coordinates) to `landmarks` [n] (image pixels) with least squares: Umeyama 1991, "Least-Squares
// Estimation of Transformation Parameters Between Two Point Patterns", in closed form for the
// plane. False, and `crop` unchanged, if points are not finite or all coincide.
[[nodiscard]] bool fit_crop(std::span<const Point> shape, std::span<const Point> landmarks,
                            Crop& crop);

}  // namespace mien::tracker
