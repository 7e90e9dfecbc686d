// Implements `mien bench --levels`, which measures a frame at each level of detail, stage by stage,
// its networks, and the creation of a tracker.
#pragma once

#include "apps/mien/bench/bench.h"

namespace mien::app {

// Throws Failure.
void bench_levels(const BenchOptions& options);

}  // namespace mien::app
