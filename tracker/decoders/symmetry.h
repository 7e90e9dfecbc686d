// Reduces small differences between the left and right control of a pair, such as mouthSmileLeft
// and mouthSmileRight.
#pragma once

#include <cstdint>
#include <span>

#include "tracker/decoders/controls.h"

namespace mien::tracker {

// Smaller differences are within the decoders' error: they also occur for symmetric faces.
inline constexpr float kSymmetryThreshold = 0.05f;

// Moves both sides of each supported pair (bit i of `supported`: control i) towards each other if
// they differ by less than kSymmetryThreshold; the smaller the difference, the larger the fraction
// removed. The mean stays. No control changes by more than kSymmetryThreshold / 8.
void symmetrize(std::uint64_t supported, std::span<float, kControls> controls);

}  // namespace mien::tracker
