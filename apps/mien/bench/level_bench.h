// `mien bench --levels`: what a frame costs at each level of detail, stage by stage, and how much
// of that is the networks; and how long a tracker takes to be made.
#pragma once

#include "apps/mien/bench/bench.h"

namespace mien::app {

// Throws Failure.
void bench_levels(const BenchOptions& options);

}  // namespace mien::app
