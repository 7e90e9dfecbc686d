// Converts the timestamps of images to steps, and detects discontinuities.
#pragma once

#include <algorithm>
#include <cstdint>

namespace mien::tracker {

class Timeline {
 public:
  struct Step {
    float seconds;  // since the previous image, 0..1
    bool cut;       // a step back, or forward by more than a second
  };

  // Accepts any value: the difference is modulo 2^64, so it cannot overflow.
  [[nodiscard]] Step advance(std::int64_t pts_ns) {
    const bool first = !started_;
    const bool back = pts_ns < previous_ns_;
    const std::uint64_t gap_ns =
        static_cast<std::uint64_t>(pts_ns) - static_cast<std::uint64_t>(previous_ns_);
    started_ = true;
    previous_ns_ = pts_ns;
    if (first || gap_ns == 0) {
      return {kNominalSeconds, false};
    }
    if (back) {
      return {kNominalSeconds, true};
    }
    const float seconds = static_cast<float>(gap_ns) * 1e-9f;
    return {std::min(seconds, kCutSeconds), gap_ns > kCutNs};
  }

 private:
  static constexpr float kNominalSeconds = 1.0f / 30.0f;
  static constexpr float kCutSeconds = 1.0f;
  static constexpr std::uint64_t kCutNs = 1'000'000'000;

  bool started_ = false;
  std::int64_t previous_ns_ = 0;
};

}  // namespace mien::tracker
