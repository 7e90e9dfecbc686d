// Which frame of one file of curves belongs to which of another.
#pragma once

#include <cstddef>
#include <vector>

#include "apps/mien/compare/curves_file.h"

namespace mien::app {

struct FramePair {
  std::size_t a, b;
};

// Frames that are each other's nearest in time and less than half a frame of the slower file
// apart, in order of time. No frame is in two pairs, and exchanging the files changes nothing.
std::vector<FramePair> match_frames(const Curves& a, const Curves& b);

}  // namespace mien::app
