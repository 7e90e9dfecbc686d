// Refines a head pose so that it agrees with the landmarks.
#pragma once

#include <cstddef>
#include <span>

#include "tracker/encoders/landmarks.h"
#include "tracker/geometry/head_pose.h"

namespace mien::tracker {

// The landmarks of an average head at rest: x, y, z of each in head space, metres.
inline constexpr std::size_t kHeadPoints = 3 * kLandmarks;
using HeadPoints = std::span<const float>;  // [kHeadPoints]; empty: unknown

// Takes one Gauss-Newton step from `pose` towards the pose that projects the points of the average
// head onto `landmarks` (pixels). It minimizes the squared distances, relative to the size of a
// head, plus the weighted square of the rotation (radians): the decoder uses more than the
// landmarks, and a person's head differs from the average one. `pose` stays unchanged if the points
// are unknown or not all in front of the camera, or if the refined pose is not plausible.
void refine_head_pose(HeadPoints head, const Landmarks& landmarks, const Camera& camera,
                      HeadPose& pose);

}  // namespace mien::tracker
