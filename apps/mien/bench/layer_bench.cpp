// Measures the layers of a network.
#include "apps/mien/bench/layer_bench.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace mien::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLayerSeconds = 0.5;
constexpr std::size_t kMinTurns = 20;

// [step][run], sorted.
std::vector<std::vector<double>> times_us(Network& runner) {
  std::vector<std::vector<double>> times(static_cast<std::size_t>(runner.step_count()));
  const auto begin = Clock::now();
  auto now = begin;
  while (times.front().size() < kMinTurns ||
         std::chrono::duration<double>(now - begin).count() < kLayerSeconds) {
    for (std::size_t i = 0; i < times.size(); ++i) {
      const auto step_begin = Clock::now();
      runner.run_step(static_cast<std::int32_t>(i));
      now = Clock::now();
      times[i].push_back(std::chrono::duration<double, std::micro>(now - step_begin).count());
    }
  }
  for (std::vector<double>& one : times) {
    std::sort(one.begin(), one.end());
  }
  return times;
}

StepTime describe(const WeightsContent& file, std::int32_t network, Network::StepLayers layers) {
  StepTime step{layers.first + 1, layers.count, "", {}, 0, 0, 0, 0, 0};
  for (std::int32_t i = layers.first; i < layers.first + layers.count; ++i) {
    const LayerInfo layer = file.layer(network, i);
    step.ops.append(step.ops.empty() ? "" : "+").append(layer.op);
    step.output = layer.output;
    step.macs += layer.macs;
  }
  return step;
}

}  // namespace

std::vector<StepTime> time_steps(const WeightsContent& file, std::int32_t network, Network& runner,
                                 double peak) {
  std::vector<StepTime> steps;
  for (const std::vector<double>& us : times_us(runner)) {
    const auto i = static_cast<std::int32_t>(steps.size());
    StepTime step = describe(file, network, runner.step_layers(i));
    step.min_us = us.front();
    step.median_us = us[us.size() / 2];
    step.gflops = 2.0 * static_cast<double>(step.macs) / step.median_us * 1e-3;
    step.peak_fraction = step.gflops / peak;
    steps.push_back(step);
  }
  return steps;
}

nlohmann::ordered_json to_json(const std::vector<StepTime>& steps) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const StepTime& s : steps) {
    json.push_back({{"first_layer", s.first_layer},
                    {"layers", s.layers},
                    {"ops", s.ops},
                    {"output", {s.output.height, s.output.width, s.output.channels}},
                    {"macs", s.macs},
                    {"min_us", s.min_us},
                    {"median_us", s.median_us},
                    {"gflops", s.gflops},
                    {"peak_fraction", s.peak_fraction}});
  }
  return json;
}

void print(const std::vector<StepTime>& steps) {
  for (const StepTime& s : steps) {
    std::printf("  %3d %-36s %4dx%dx%-5d %9llu %8.2f us %8.2f us %8.2f %5.0f%%\n", s.first_layer,
                s.ops.c_str(), s.output.height, s.output.width, s.output.channels,
                static_cast<unsigned long long>(s.macs), s.min_us, s.median_us, s.gflops,
                s.peak_fraction * 100.0);
  }
}

}  // namespace mien::app
