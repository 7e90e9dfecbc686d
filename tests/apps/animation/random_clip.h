// Clips with random controls and head poses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

#include "apps/animation/animation.h"

namespace mien::animation {

inline double fraction(std::mt19937& random) {
  return std::uniform_int_distribution(0, 9)(random) == 0
             ? 0.0
             : std::uniform_real_distribution(0.0, 1.0)(random);
}

inline Clip random_clip(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  Clip clip;
  for (std::size_t i = 0; i < count; ++i) {
    Frame frame;
    frame.number = static_cast<std::int64_t>(i);
    frame.time_ns = static_cast<std::int64_t>(i) * 40'000'000;
    for (double& value : frame.controls) {
      value = fraction(random);
    }
    frame.head = {fraction(random), fraction(random), -fraction(random)};
    frame.position_m = {fraction(random), fraction(random), fraction(random)};
    clip.frames.push_back(frame);
  }
  return clip;
}

}  // namespace mien::animation
