// Estimates recording times from arrival times of blocks.
#include "apps/mien/sources/sample_clock.h"

namespace mien::app {

std::int64_t SampleClock::time_of(std::int64_t samples, std::int64_t now_ns) {
  constexpr std::int64_t kGapNs = 300'000'000;
  const std::int64_t expected_ns = begin_ns_ + duration_ns(samples_ + samples);
  const std::int64_t late_ns = now_ns - expected_ns;
  if (!begun_ || late_ns > kGapNs) {  // after a gap, restart
    begun_ = true;
    samples_ = 0;
    begin_ns_ = now_ns - duration_ns(samples);
  } else {
    // No block arrives before it was recorded, so an early block corrects the clock at once. A late
    // block may have been delayed; only if all blocks are late is the clock of the sound card
    // slower, so they correct it slowly.
    begin_ns_ += late_ns < 0 ? late_ns : late_ns / 1000;
  }
  const std::int64_t first_ns = begin_ns_ + duration_ns(samples_);
  samples_ += samples;
  return first_ns;
}

}  // namespace mien::app
