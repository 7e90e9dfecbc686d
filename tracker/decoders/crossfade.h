// The crossfade between two controls decoders, without a jump.
#pragma once

#include <algorithm>

namespace mien::tracker {

// The signal that fades in runs with weight 0 for kWarmUpSeconds, until its state is settled.
class Crossfade {
 public:
  void jump(bool second) { position_ = second ? kEnd : 0.0f; }

  void advance(bool second, float seconds) {
    position_ = std::clamp(position_ + (second ? seconds : -seconds), 0.0f, kEnd);
  }

  [[nodiscard]] bool first_is_active() const { return position_ < kEnd; }
  [[nodiscard]] bool second_is_active() const { return position_ > 0.0f; }

  // Weight of the second signal, 0..1: a smoothstep between the warm-up phases at both ends.
  [[nodiscard]] float weight() const {
    const float t = std::clamp((position_ - kWarmUpSeconds) / kFadeSeconds, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
  }

 private:
  static constexpr float kWarmUpSeconds = 0.25f;
  static constexpr float kFadeSeconds = 1.5f;
  static constexpr float kEnd = kFadeSeconds + 2 * kWarmUpSeconds;

  float position_ = 0.0f;  // seconds, 0 (first signal) .. kEnd (second)
};

}  // namespace mien::tracker
