// Head pose, brought to the landmarks that were found.
#pragma once

#include <cstddef>
#include <span>

#include "tracker/encoders/landmarks.h"
#include "tracker/geometry/head_pose.h"

namespace mien::tracker {

// Where the landmarks are on an average head at rest: x, y, z of each, in its own frame, metres.
inline constexpr std::size_t kHeadPoints = 3 * kLandmarks;
using HeadPoints = std::span<const float>;  // kHeadPoints of them; empty: unknown

// One Gauss-Newton step from `pose` towards one in which the average head's points are seen where
// `landmarks` are, pixels. It is least squares of their distances, in shares of a head's size, and
// of how far the rotation turns, radians: the decoder sees what distances between points do not
// tell, and an average head is not everyone's. `pose` stays as it was if the points are unknown,
// not all in front of the camera, or what comes out is not plausible.
void refine_head_pose(HeadPoints head, const Landmarks& landmarks, const Camera& camera,
                      HeadPose& pose);

}  // namespace mien::tracker
