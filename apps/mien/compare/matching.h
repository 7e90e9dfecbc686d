// Matches frames of two animations by time.
#pragma once

#include <cstddef>
#include <vector>

#include "apps/mien/compare/curves_file.h"

namespace mien::app {

struct FramePair {
  std::size_t a, b;
};

// Pairs of frames that are nearest to each other and closer than half a frame of the slower file,
// in order of time. Each frame is in at most one pair. The result is symmetric in both files.
std::vector<FramePair> match_frames(const Curves& a, const Curves& b);

}  // namespace mien::app
