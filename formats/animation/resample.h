// A clip at other times.
#pragma once

#include <vector>

#include "formats/animation/clip.h"

namespace mien::formats {

// Frames 1/fps apart, counted from `origin_ns`, which is not after the first frame and
// a time that is allowed, and from the
// first to the last frame; of one face. Values lie on the
// straight line between their neighbours, the head on the shorter way; what only one neighbour
// has, and states and mouth shapes, are those of the frame before. At the time of a frame stands
// that frame, exactly.
[[nodiscard]] std::vector<Frame> resampled(const std::vector<Frame>& frames, double fps,
                                           std::int64_t origin_ns);

}  // namespace mien::formats
