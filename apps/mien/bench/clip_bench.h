// `mien bench --clip`: what following a face saves over searching it on every frame.
#pragma once

#include "apps/mien/bench/bench.h"

namespace mien::app {

// Throws Failure.
void bench_clip(const BenchOptions& options);

}  // namespace mien::app
