// Hands a face over from one controls decoder to another without a jump.
#pragma once

#include <algorithm>

namespace mien::tracker {

// Between two signals: 0 is all of the first, 1 all of the second. The one that fades in has no
// weight while its state warms up.
class Crossfade {
 public:
  void jump(bool second) { position_ = second ? kEnd : 0.0f; }

  void advance(bool second, float seconds) {
    position_ = std::clamp(position_ + (second ? seconds : -seconds), 0.0f, kEnd);
  }

  [[nodiscard]] bool first_is_active() const { return position_ < kEnd; }
  [[nodiscard]] bool second_is_active() const { return position_ > 0.0f; }

  // Of the second signal: smoothstep over the middle of the way.
  [[nodiscard]] float weight() const {
    const float t = std::clamp((position_ - kWarmUpSeconds) / kFadeSeconds, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
  }

 private:
  static constexpr float kWarmUpSeconds = 0.25f;
  static constexpr float kFadeSeconds = 1.5f;
  static constexpr float kEnd = kFadeSeconds + 2 * kWarmUpSeconds;

  float position_ = 0.0f;
};

}  // namespace mien::tracker
