// The table of Roblox's units and ARKit's controls, shared by readers, writers and the library.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/vocabulary/vocabulary.h"

namespace mien::formats {

enum class Join : std::uint8_t { kMean, kMax, kMin };

// How a unit of Roblox is derived from ARKit's controls: as the mean, maximum or minimum of one or
// two controls. In the other direction a control is the mean of its units; the minimum (Corrugator)
// adds no information and is ignored.
struct FacsRow {
  std::size_t unit;
  std::size_t first, second;  // equal: a single control
  Join join = Join::kMean;
};

constexpr FacsRow of_one(std::size_t unit, std::size_t only) { return {unit, only, only}; }

inline constexpr FacsRow kFacsRows[] = {
    of_one(facs_unit("LeftEyeClosed"), control("eyeBlinkLeft")),
    of_one(facs_unit("RightEyeClosed"), control("eyeBlinkRight")),
    of_one(facs_unit("LeftEyeUpperLidRaiser"), control("eyeWideLeft")),
    of_one(facs_unit("RightEyeUpperLidRaiser"), control("eyeWideRight")),
    {facs_unit("LeftCheekRaiser"), control("eyeSquintLeft"), control("cheekSquintLeft"),
     Join::kMax},
    {facs_unit("RightCheekRaiser"), control("eyeSquintRight"), control("cheekSquintRight"),
     Join::kMax},
    {facs_unit("EyesLookUp"), control("eyeLookUpLeft"), control("eyeLookUpRight")},
    {facs_unit("EyesLookDown"), control("eyeLookDownLeft"), control("eyeLookDownRight")},
    {facs_unit("EyesLookLeft"), control("eyeLookOutLeft"), control("eyeLookInRight")},
    {facs_unit("EyesLookRight"), control("eyeLookInLeft"), control("eyeLookOutRight")},
    of_one(facs_unit("JawDrop"), control("jawOpen")),
    of_one(facs_unit("JawLeft"), control("jawLeft")),
    of_one(facs_unit("JawRight"), control("jawRight")),
    of_one(facs_unit("LipsTogether"), control("mouthClose")),
    of_one(facs_unit("Funneler"), control("mouthFunnel")),
    of_one(facs_unit("Pucker"), control("mouthPucker")),
    of_one(facs_unit("MouthLeft"), control("mouthLeft")),
    of_one(facs_unit("MouthRight"), control("mouthRight")),
    of_one(facs_unit("LeftLipCornerPuller"), control("mouthSmileLeft")),
    of_one(facs_unit("RightLipCornerPuller"), control("mouthSmileRight")),
    of_one(facs_unit("LeftLipCornerDown"), control("mouthFrownLeft")),
    of_one(facs_unit("RightLipCornerDown"), control("mouthFrownRight")),
    of_one(facs_unit("LeftDimpler"), control("mouthDimpleLeft")),
    of_one(facs_unit("RightDimpler"), control("mouthDimpleRight")),
    of_one(facs_unit("LeftLipStretcher"), control("mouthStretchLeft")),
    of_one(facs_unit("RightLipStretcher"), control("mouthStretchRight")),
    of_one(facs_unit("LowerLipSuck"), control("mouthRollLower")),
    of_one(facs_unit("UpperLipSuck"), control("mouthRollUpper")),
    of_one(facs_unit("ChinRaiser"), control("mouthShrugLower")),
    of_one(facs_unit("ChinRaiserUpperLip"), control("mouthShrugUpper")),
    {facs_unit("LipPresser"), control("mouthPressLeft"), control("mouthPressRight")},
    of_one(facs_unit("LeftLowerLipDepressor"), control("mouthLowerDownLeft")),
    of_one(facs_unit("RightLowerLipDepressor"), control("mouthLowerDownRight")),
    of_one(facs_unit("LeftUpperLipRaiser"), control("mouthUpperUpLeft")),
    of_one(facs_unit("RightUpperLipRaiser"), control("mouthUpperUpRight")),
    of_one(facs_unit("LeftBrowLowerer"), control("browDownLeft")),
    of_one(facs_unit("RightBrowLowerer"), control("browDownRight")),
    {facs_unit("Corrugator"), control("browDownLeft"), control("browDownRight"), Join::kMin},
    of_one(facs_unit("LeftInnerBrowRaiser"), control("browInnerUp")),
    of_one(facs_unit("RightInnerBrowRaiser"), control("browInnerUp")),
    of_one(facs_unit("LeftOuterBrowRaiser"), control("browOuterUpLeft")),
    of_one(facs_unit("RightOuterBrowRaiser"), control("browOuterUpRight")),
    of_one(facs_unit("LeftCheekPuff"), control("cheekPuff")),
    of_one(facs_unit("RightCheekPuff"), control("cheekPuff")),
    of_one(facs_unit("LeftNoseWrinkler"), control("noseSneerLeft")),
    of_one(facs_unit("RightNoseWrinkler"), control("noseSneerRight")),
    of_one(facs_unit("TongueOut"), control("tongueOut")),
};

}  // namespace mien::formats
