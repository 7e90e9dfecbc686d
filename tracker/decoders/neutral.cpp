// Captures the neutral values of the controls.
#include "tracker/decoders/neutral.h"

#include <cmath>

namespace mien::tracker {

void Neutral::set(std::span<const float, kControls> levels) {
  std::transform(levels.begin(), levels.end(), levels_.begin(),
                 [](float level) { return std::clamp(level, 0.0f, kMax); });
  captured_ = true;
}

// After the last frame, computes the median of every control.
void Neutral::observe(std::span<const float, kControls> controls) {
  if (!is_being_captured()) {
    return;
  }
  if (frame_ >= 0) {
    for (std::size_t i = 0; i < controls.size(); ++i) {
      captured_frames_[i][static_cast<std::size_t>(frame_)] =
          static_cast<std::uint16_t>(std::lround(controls[i] * kSteps));
    }
  }
  if (++frame_ < kFrames) {
    return;
  }
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    auto* const median = captured_frames_[i].begin() + kFrames / 2;
    std::nth_element(captured_frames_[i].begin(), median, captured_frames_[i].end());
    levels_[i] = std::min(static_cast<float>(*median) / kSteps, kMax);
  }
  captured_ = true;
}

}  // namespace mien::tracker
