// Feeds audio to a tracker ahead of its video frames.
#include "apps/mien/sources/audio_source.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

// The tracker needs audio ahead of a frame, because AudioNet's windows are centred 42 ms earlier.
constexpr std::int64_t kAheadNs = 100'000'000;

float peak_amplitude(const Audio& block) {
  const std::span<const float> samples(static_cast<const float*>(block.samples[0]),
                                       block.frames * static_cast<std::size_t>(block.channels));
  float peak = 0.0f;
  for (const float sample : samples) {
    peak = std::max(peak, std::abs(sample));  // std::max ignores NaN
  }
  return peak;
}

}  // namespace

void AudioFeed::push_until(std::int64_t pts_ns, Tracker& tracker) {
  Audio block;
  std::int64_t block_ns = 0;
  while (!ended_ && !lasts_until(pts_ns + kAheadNs)) {
    if (!source_->next(block, block_ns)) {
      ended_ = true;
      return;
    }
    const mien_status status = tracker.push_audio(block, block_ns);
    if (status != MIEN_OK) {
      throw Failure(kExitInternal, input_ + ": audio: " + message(status));
    }
    if (listener_) {
      listener_(block, block_ns);
    }
    peak_ = std::max(peak_, peak_amplitude(block));
    end_ns_ =
        block_ns + static_cast<std::int64_t>(block.frames) * 1'000'000'000 / block.sample_rate;
  }
}

}  // namespace mien::app
