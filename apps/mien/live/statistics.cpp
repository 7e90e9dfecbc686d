// Statistics of a live run.
#include "apps/mien/live/statistics.h"

#include <algorithm>
#include <cmath>

namespace mien::app {
namespace {

constexpr std::int64_t kStepNs = 100'000;
constexpr double kNewFrame = 0.05;  // weight of a new frame in a moving average

}  // namespace

void Histogram::add(std::int64_t ns) {
  const auto last = static_cast<std::int64_t>(counts_.size()) - 1;
  ++counts_[static_cast<std::size_t>(std::clamp<std::int64_t>(ns / kStepNs, 0, last))];
  ++count_;
}

double Histogram::quantile(double fraction) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(count_)));
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < counts_.size() && count_ > 0; ++i) {
    below += counts_[i];
    if (below >= std::max<std::uint64_t>(wanted, 1)) {
      return static_cast<double>(i + 1) * static_cast<double>(kStepNs) * 1e-6;
    }
  }
  return 0.0;
}

void LiveStatistics::frame(const Result& result, std::int64_t now_ns, std::int64_t latency_ns) {
  ++frames_;
  face_frames_ += result.has_face() ? 1 : 0;
  if (last_ns_ != 0) {
    const double rate = 1e9 / static_cast<double>(std::max<std::int64_t>(now_ns - last_ns_, 1));
    // The mean of intervals, not of rates, gives the true frame rate.
    fps_ = fps_ == 0.0 ? rate : 1.0 / ((1.0 - kNewFrame) / fps_ + kNewFrame / rate);
  }
  last_ns_ = now_ns;
  for (std::size_t stage = 0; stage < stage_ms_.size(); ++stage) {
    const double ms = static_cast<double>(result.stage_ns[stage]) * 1e-6;
    stage_ms_[stage] += kNewFrame * (ms - stage_ms_[stage]);
  }
  if (latency_ns >= 0) {
    latency_.add(latency_ns);
  }
}

}  // namespace mien::app
