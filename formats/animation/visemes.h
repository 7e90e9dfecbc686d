// Between the controls of the mouth and what a viewer of lips is told: 15 visemes (OVR LipSync,
// OpenXR) and the mouth shapes of Rhubarb.
//
// Every viseme but silence is a pose of the mouth. The visemes of a frame are the mixture of these
// poses, none of them negative, that comes nearest to the frame's mouth (non-negative least
// squares); what the mixture lacks to 1 is silence, and one of more than 1 is brought down to it.
// A pose so gives its own viseme back, alone. The mouth may have been moved by sound, by the
// picture or by both. The C interface (mien_vocabulary_values) and the programs read visemes by
// these functions alone; they take no memory.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "formats/animation/vocabulary.h"

namespace mien::formats {

// Sum 1; all kNoNumber where no control of the mouth is driven.
[[nodiscard]] std::array<double, kVisemeCount> visemes_of(
    const std::array<double, kControlCount>& controls);

// The control that a pose moves most, on both sides of the face; kControlCount for silence.
[[nodiscard]] std::array<std::size_t, 2> leading_controls(std::size_t viseme);

// The controls of the mouth, the others kNoNumber; all kNoNumber where the visemes are.
[[nodiscard]] std::array<double, kControlCount> controls_of_visemes(
    std::span<const double, kVisemeCount> visemes);

// The shape of the strongest viseme; 'X' while silence has more than 3/4, or nothing is known.
[[nodiscard]] char mouth_shape_of(std::span<const double, kVisemeCount> visemes);

// One viseme at 1: A PP, B DD, C E, D aa, E oh, F ou, G FF, H TH, X sil.
[[nodiscard]] std::array<double, kVisemeCount> visemes_of_mouth_shape(char shape);

}  // namespace mien::formats
