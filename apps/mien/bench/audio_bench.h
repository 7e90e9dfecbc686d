// Implements `mien bench --sound`, which measures audio processing from samples to controls.
#pragma once

#include "apps/mien/bench/bench.h"

namespace mien::app {

// Throws Failure.
void bench_audio(const BenchOptions& options);

}  // namespace mien::app
