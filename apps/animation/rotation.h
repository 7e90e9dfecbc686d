// Converts between representations of rotations.
#pragma once

#include <array>
#include <optional>

#include "apps/animation/clip.h"

namespace mien::animation {

using Quaternion = std::array<double, 4>;  // x, y, z, w; unit length

[[nodiscard]] Quaternion quaternion(const Angles& angles);

// Pitch in -pi/2..pi/2, the others in -pi..pi; roll is 0 where yaw and roll are one (pitch of 90
// degrees). The quaternion need not have unit length, but must not be 0.
[[nodiscard]] Angles angles(const Quaternion& q);

// Rotates by b, then by a.
[[nodiscard]] Quaternion product(const Quaternion& a, const Quaternion& b);

// Interpolates from a to b along the shorter arc; fraction 0..1.
[[nodiscard]] Angles between(const Angles& a, const Angles& b, double fraction);

// Rotations of the left and right eye from the controls; nothing unless one of the eight is
// supported. 1 is 0.485 rad, as in a Live Link Face capture: eyeLookDown 0.39 with an eye pitch of
// -0.189.
[[nodiscard]] std::optional<std::array<Angles, 2>> gaze(
    const std::array<double, formats::kControlCount>& controls);

}  // namespace mien::animation
