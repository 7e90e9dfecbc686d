// Which frame of one file of curves belongs to which of another.
#pragma once

#include <cstddef>
#include <vector>

#include "apps/mien/compare/curves_file.h"

namespace mien::app {

struct FramePair {
  std::size_t a, b;
};

// Frames that are each other's nearest in time and no further apart than half a frame of the
// slower file, in order of time: no frame is in two pairs, and exchanging the files changes
// nothing.
std::vector<FramePair> match_frames(const Curves& a, const Curves& b);

}  // namespace mien::app
