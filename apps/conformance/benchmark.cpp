// Measures kernels and the peak of each tier.
#include "apps/conformance/benchmark.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>

#include "apps/conformance/case.h"

namespace mien::conformance {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSeconds = 0.03;        // per measurement
constexpr double kShortestBatch = 5e-6;  // many times the resolution of the clock

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double seconds_of(const std::function<void()>& work, int calls) {
  const auto begin = Clock::now();
  for (int i = 0; i < calls; ++i) {
    work();
  }
  return seconds_since(begin);
}

// The buffers of a case, each aligned to 64 bytes as in the engine.
class Workbench {
 public:
  explicit Workbench(const Case& test) {
    std::size_t bytes = 0;
    for (const Buffer& one : test.buffers) {
      bytes += lines(one) * sizeof(Line);
    }
    memory_ = std::make_unique<Line[]>(bytes / sizeof(Line));
    Addresses addresses;
    Line* at = memory_.get();
    for (const Buffer& one : test.buffers) {
      std::copy(one.content.begin(), one.content.end(), at->bytes);
      addresses.add(at->bytes);
      at += lines(one);
    }
    arguments_ = test.bind(addresses);
  }
  [[nodiscard]] const Arguments& arguments() const { return arguments_; }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  static std::size_t lines(const Buffer& buffer) {
    return (buffer.content.size() + sizeof(Line) - 1) / sizeof(Line);
  }
  std::unique_ptr<Line[]> memory_;
  Arguments arguments_;
};

}  // namespace

Timing timed(const std::function<void()>& work, std::uint64_t macs, double peak) {
  int calls = 1;
  while (seconds_of(work, calls) < kShortestBatch) {
    calls *= 2;
  }
  double best = std::numeric_limits<double>::infinity();
  const auto begin = Clock::now();
  do {
    best = std::min(best, seconds_of(work, calls) / calls);
  } while (seconds_since(begin) < kSeconds);
  Timing timing;
  timing.seconds = best;
  timing.gflops = 2.0 * static_cast<double>(macs) / best * 1e-9;
  timing.peak_share = peak > 0.0 ? timing.gflops / peak : 0.0;
  return timing;
}

double peak_gflops(kernels::Tier tier) {
  const auto loop = kernels::find<kernels::FmaPeakArgs>(kernels::bit(tier));
  if (loop == nullptr) {
    return 0.0;
  }
  float sums[8];
  std::int64_t macs = 0;
  const auto work = [&] { loop({sums, 20'000, &macs}); };
  work();
  return timed(work, static_cast<std::uint64_t>(macs), 0.0).gflops;
}

Timing time_kernel(const kernels::Entry& entry, double peak) {
  RandomValues random(1, Pattern::kOrdinary);
  const Case test = find_family(entry.family)->typical_case(random);
  const Workbench bench(test);
  return timed([&] { test.call(entry.function, bench.arguments()); }, test.macs, peak);
}

}  // namespace mien::conformance
