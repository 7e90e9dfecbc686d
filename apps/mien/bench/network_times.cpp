// Measures a network run by run.
#include "apps/mien/bench/network_times.h"

#include <algorithm>
#include <chrono>
#include <random>

namespace mien::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kNetworkSeconds = 0.5;
constexpr std::size_t kMinRuns = 20;
constexpr std::size_t kMaxRuns = 5000;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

std::vector<double> network_times_ms(Network& runner) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> values(-1.0f, 1.0f);
  for (float& value : runner.input()) {
    value = values(random);
  }
  runner.run();
  std::vector<double> times;
  const auto begin = Clock::now();
  while (times.size() < kMinRuns ||
         (times.size() < kMaxRuns && seconds_since(begin) < kNetworkSeconds)) {
    const auto run_begin = Clock::now();
    runner.run();
    times.push_back(seconds_since(run_begin) * 1e3);
  }
  std::sort(times.begin(), times.end());
  return times;
}

}  // namespace mien::app
