#include "apps/mien/sources/sample_clock.h"

namespace mien::app {

std::int64_t SampleClock::time_of(std::int64_t samples, std::int64_t now_ns) {
  constexpr std::int64_t kGapNs = 300'000'000;
  const std::int64_t expected_ns = begin_ns_ + duration_ns(samples_ + samples);
  const std::int64_t late_ns = now_ns - expected_ns;
  if (!begun_ || late_ns > kGapNs) {  // nothing came for a while: count anew
    begun_ = true;
    samples_ = 0;
    begin_ns_ = now_ns - duration_ns(samples);
  } else {
    // Nothing comes before it was recorded; what comes late may be waiting somewhere, and only
    // where all of it is late the sound card's clock is slower than ours.
    begin_ns_ += late_ns < 0 ? late_ns : late_ns / 1000;
  }
  const std::int64_t first_ns = begin_ns_ + duration_ns(samples_);
  samples_ += samples;
  return first_ns;
}

}  // namespace mien::app
