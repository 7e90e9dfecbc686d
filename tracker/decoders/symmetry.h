// Both sides of a pair of controls, such as mouthSmileLeft and mouthSmileRight.
#pragma once

#include <cstdint>
#include <span>

#include "tracker/decoders/controls.h"

namespace mien::tracker {

// Differences of two sides that are smaller say little: decoders give even faces such ones, too.
inline constexpr float kSymmetryThreshold = 0.05f;

// Brings both sides of each pair that is driven (bit i of `supported`: control i) together where
// they are less than kSymmetryThreshold apart, the more the nearer they are; their mean stays. No
// control moves by more than an eighth of kSymmetryThreshold.
void symmetrize(std::uint64_t supported, std::span<float, kControls> controls);

}  // namespace mien::tracker
