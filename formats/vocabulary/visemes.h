// Conversion between controls of the mouth, 15 visemes (OVR LipSync, OpenXR) and the mouth shapes
// of Rhubarb.
//
// Every viseme except silence is a pose of the mouth. The visemes of a frame are the non-negative
// mixture of poses nearest to the frame's mouth (non-negative least squares). Silence is the
// remainder to 1; a sum above 1 is normalized. A pose therefore gives exactly its own viseme.
// Video, audio or both may have moved the mouth. The C API (mien_vocabulary_values) and the
// programs use these functions, which allocate no memory.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "formats/vocabulary/vocabulary.h"

namespace mien::formats {

// The sum is 1; all are kNoNumber if no control of the mouth is supported.
[[nodiscard]] std::array<double, kVisemeCount> visemes_of(
    const std::array<double, kControlCount>& controls);

// The control with the largest weight in a pose, on both sides; kControlCount for silence.
[[nodiscard]] std::array<std::size_t, 2> leading_controls(std::size_t viseme);

// The controls of the mouth; others are kNoNumber, and all are if the visemes are.
[[nodiscard]] std::array<double, kControlCount> controls_of_visemes(
    std::span<const double, kVisemeCount> visemes);

// The shape of the strongest viseme; 'X' if silence is above 3/4 or the visemes are unknown.
[[nodiscard]] char mouth_shape_of(std::span<const double, kVisemeCount> visemes);

// One viseme is 1: A PP, B DD, C E, D aa, E oh, F ou, G FF, H TH, X sil.
[[nodiscard]] std::array<double, kVisemeCount> visemes_of_mouth_shape(char shape);

}  // namespace mien::formats
