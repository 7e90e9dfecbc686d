// Head motion as BVH: one joint, Head, with position (BVH itself has no unit of length) and
// rotation (degrees, in the order y, x, z, which is that of Angles). Frames without a head hold the
// last.
//
// BVH knows one time between frames and no time of the first: frames that do not lie evenly are
// brought to even steps.
#pragma once

#include <memory>
#include <string_view>

#include "formats/animation/clip.h"
#include "formats/animation/fault.h"
#include "formats/animation/read_options.h"
#include "formats/animation/writer.h"

namespace mien::formats {

[[nodiscard]] std::unique_ptr<AnimationWriter> bvh_writer(LengthUnit unit);

// Any skeleton: where a joint called Head, or one whose name ends so, stands and looks in the
// world, or the root without such a one. Which unit lengths have without bvh_unit the distance from
// the root to the head shows, or the length of the head; a note says so. On a fault `clip` stays as
// it was.
[[nodiscard]] bool read_bvh(std::string_view text, const ReadOptions& options, Clip& clip,
                            Fault& fault);

}  // namespace mien::formats
