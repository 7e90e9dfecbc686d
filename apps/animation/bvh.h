// Head motion as BVH: one joint, Head, with position (BVH has no unit of length) and rotation
// (degrees, in the order y, x, z, as in Angles). Frames without a head repeat the last one.
//
// BVH has one time step and no start time, so frames with uneven times are resampled.
#pragma once

#include <memory>
#include <string_view>

#include "apps/animation/clip.h"
#include "apps/animation/fault.h"
#include "apps/animation/read_options.h"
#include "apps/animation/writer.h"

namespace mien::animation {

[[nodiscard]] std::unique_ptr<AnimationWriter> bvh_writer(LengthUnit unit);

// Reads the motion of a joint in world space: the one whose name is or ends in "Head", or else the
// root. Without bvh_unit, the distance from root to head, or the length of the head, determines the
// unit, and a note names it. Leaves `clip` unchanged on failure.
[[nodiscard]] bool read_bvh(std::string_view text, const ReadOptions& options, Clip& clip,
                            Fault& fault);

}  // namespace mien::animation
