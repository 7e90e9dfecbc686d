// Assigns times to audio samples from timestamps and sample counts.
#include "audio/audio_clock.h"

#include <algorithm>
#include <cmath>

#include "audio/timestamps.h"

namespace mien::audio {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr double kLoopSeconds = 1.0;

bool within(std::int64_t value, std::int64_t bound) { return value >= -bound && value <= bound; }

}  // namespace

// Converts whole seconds separately, because the frames of many days times 1e9 overflow 64 bits.
std::int64_t AudioClock::end_ns(std::int32_t rate) const {
  const std::int64_t whole_seconds = frames_ / rate;
  const std::int64_t remaining_frames = frames_ % rate;
  const std::int64_t elapsed_ns =
      whole_seconds * kNsPerSecond + remaining_frames * kNsPerSecond / rate;
  return later(origin_ns_, elapsed_ns + std::llround(correction_ns_));
}

AudioClock::Flow AudioClock::advance(std::int64_t pts_ns, std::size_t frames, std::int32_t rate) {
  const std::int64_t error = started_ ? from_to(end_ns(rate), pts_ns) : 0;
  Flow flow = Flow::kSteady;
  if (!started_ || !within(error, kMaxHopNs)) {
    flow = Flow::kBreak;
    started_ = true;
    origin_ns_ = pts_ns;
    correction_ns_ = 0.0;
    frames_ = 0;
  } else if (!within(error, kMaxSlewNs)) {
    flow = Flow::kHop;
    origin_ns_ = later(origin_ns_, error);
  } else if (!within(error, kToleranceNs)) {
    const double seconds = static_cast<double>(frames) / rate;
    correction_ns_ += static_cast<double>(error) * std::min(seconds / kLoopSeconds, 1.0);
  }
  frames_ += static_cast<std::int64_t>(frames);
  return flow;
}

std::int64_t AudioClock::time_ns(double seconds) const {
  return later(origin_ns_, std::llround(correction_ns_ + seconds * 1e9));
}

}  // namespace mien::audio
