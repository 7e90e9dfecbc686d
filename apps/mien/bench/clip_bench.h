// Implements `mien bench --clip`, which compares tracking with detection on every frame.
#pragma once

#include "apps/mien/bench/bench.h"

namespace mien::app {

// Throws Failure.
void bench_clip(const BenchOptions& options);

}  // namespace mien::app
