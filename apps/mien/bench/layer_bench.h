// Measures each step of a network: a layer, or several fused layers.
#pragma once

#include <mien/engine.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace mien::app {

struct StepTime {
  std::int32_t first_layer, layers;  // counted from 1
  std::string ops;                   // "pointwise+add"
  TensorShape output;
  std::uint64_t macs;
  double min_us, median_us;
  double gflops;  // from the median; a multiply-accumulate counts as two operations
  double peak_fraction;
};

// Measures every step inside whole runs, so that caches behave as in use. `network` is the index in
// `file` of the network that `runner` runs; `peak` is in GFLOP/s.
std::vector<StepTime> time_steps(const WeightsContent& file, std::int32_t network, Network& runner,
                                 double peak);

nlohmann::ordered_json to_json(const std::vector<StepTime>& steps);
void print(const std::vector<StepTime>& steps);

}  // namespace mien::app
