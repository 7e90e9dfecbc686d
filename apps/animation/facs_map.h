// Conversion between ARKit's 52 controls and Roblox's 50 units. No official table exists; this one
// follows Meta's published mappings of ARKit and FACS.
#pragma once

#include <array>
#include <span>

#include "formats/vocabulary/vocabulary.h"

namespace mien::animation {

// kNoNumber if the controls of a unit are unknown, and for FlatPucker, TongueUp and TongueDown,
// which ARKit lacks.
[[nodiscard]] std::array<double, formats::kFacsCount> facs_of(
    const std::array<double, formats::kControlCount>& controls);

// kNoNumber for jawForward, which Roblox lacks, and if the units are kNoNumber.
[[nodiscard]] std::array<double, formats::kControlCount> controls_of_facs(
    std::span<const double, formats::kFacsCount> facs);

}  // namespace mien::animation
