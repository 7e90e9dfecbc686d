// Subtracts the running level of audio.
#include "audio/loudness.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mien::audio {

void Loudness::reset() { level_ = std::log(kEnergyFloor); }

void Loudness::subtract(std::span<const float, kBands> log_mel, std::span<float, kBands> relative) {
  const float mean =
      std::accumulate(log_mel.begin(), log_mel.end(), 0.0f) / static_cast<float>(kBands);
  level_ += (mean - level_) / (mean > level_ ? kAttack : kRelease);
  std::transform(log_mel.begin(), log_mel.end(), relative.begin(),
                 [this](float energy) { return energy - level_; });
}

}  // namespace mien::audio
