// Reduces audio to a waveform.
#include "apps/mien/report/waveform.h"

#include <algorithm>

namespace mien::app {

void Waveform::push_audio(const Audio& block, std::int64_t pts_ns) {
  if (empty()) {
    start_ns_ = pts_ns;
  }
  const auto* samples = static_cast<const float*>(block.samples[0]);
  for (std::size_t i = 0; i < block.frames; ++i) {
    const std::int64_t at_ns =
        pts_ns - start_ns_ + static_cast<std::int64_t>(i) * 1'000'000'000 / block.sample_rate;
    if (at_ns < 0) {
      continue;
    }
    const auto bin = static_cast<std::size_t>(at_ns / kBinNs);
    if (bin >= low_.size()) {
      low_.resize(bin + 1, 0.0);
      high_.resize(bin + 1, 0.0);
    }
    const double sample = samples[i * static_cast<std::size_t>(block.channels)];
    low_[bin] = std::min(low_[bin], sample);
    high_[bin] = std::max(high_[bin], sample);
  }
}

}  // namespace mien::app
