// Measures the time of a network.
#pragma once

#include <mien/engine.h>

#include <cstdint>
#include <string>
#include <vector>

namespace mien::app {

// Milliseconds, sorted, of runs on random input.
[[nodiscard]] std::vector<double> network_times_ms(Network& runner);

}  // namespace mien::app
