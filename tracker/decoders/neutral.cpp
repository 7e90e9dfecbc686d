#include "tracker/decoders/neutral.h"

#include <cmath>

namespace mien::tracker {

void Neutral::set(std::span<const float, kControls> levels) {
  std::transform(levels.begin(), levels.end(), levels_.begin(),
                 [](float level) { return std::clamp(level, 0.0f, kLargest); });
  captured_ = true;
}

// The median of every control over the frames.
void Neutral::observe(std::span<const float, kControls> controls) {
  if (!is_being_captured()) {
    return;
  }
  if (frame_ >= 0) {
    for (std::size_t i = 0; i < controls.size(); ++i) {
      seen_[i][static_cast<std::size_t>(frame_)] =
          static_cast<std::uint16_t>(std::lround(controls[i] * kSteps));
    }
  }
  if (++frame_ < kFrames) {
    return;
  }
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    auto* const middle = seen_[i].begin() + kFrames / 2;
    std::nth_element(seen_[i].begin(), middle, seen_[i].end());
    levels_[i] = std::min(static_cast<float>(*middle) / kSteps, kLargest);
  }
  captured_ = true;
}

}  // namespace mien::tracker
