// Between ARKit's 52 controls and Roblox's 50 units. No official table exists; this one goes over
// what Meta publishes of ARKit and FACS.
#pragma once

#include <array>
#include <span>

#include "formats/animation/vocabulary.h"

namespace mien::formats {

// kNoNumber where nothing drives what a unit is made of, and for FlatPucker, TongueUp and
// TongueDown, which ARKit does not know.
[[nodiscard]] std::array<double, kFacsCount> facs_of(
    const std::array<double, kControlCount>& controls);

// kNoNumber for jawForward, which Roblox does not know, and where the units are kNoNumber.
[[nodiscard]] std::array<double, kControlCount> controls_of_facs(
    std::span<const double, kFacsCount> facs);

}  // namespace mien::formats
