// Names of animation values in every supported vocabulary, each in its own order; left and right
// are the subject's. Never exchange values by index between vocabularies.
//
// Writers use this spelling; readers use `index_of`, which ignores case.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

namespace mien::formats {

// An unknown number, such as an unsupported control.
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

// Whether the control is supported.
[[nodiscard]] constexpr bool driven(double value) { return value == value; }

// For formats without unknown values: unsupported controls are 0.
[[nodiscard]] constexpr double or_zero(double value) { return driven(value) ? value : 0.0; }

inline constexpr std::size_t kControlCount = 52;
inline constexpr std::size_t kRotationCount = 9;  // head and eyes in Live Link Face
inline constexpr std::size_t kFacsCount = 50;
inline constexpr std::size_t kVisemeCount = 15;

// ARKit's 52 controls in the order of Apple's Live Link wire format (Epic's EARFaceBlendShape),
// which is the order of this project's controls. Live Link Face capitalizes the first letter.
inline constexpr std::array<std::string_view, kControlCount> kArkitNames = {
    "eyeBlinkLeft",      "eyeLookDownLeft",    "eyeLookInLeft",
    "eyeLookOutLeft",    "eyeLookUpLeft",      "eyeSquintLeft",
    "eyeWideLeft",       "eyeBlinkRight",      "eyeLookDownRight",
    "eyeLookInRight",    "eyeLookOutRight",    "eyeLookUpRight",
    "eyeSquintRight",    "eyeWideRight",       "jawForward",
    "jawLeft",           "jawRight",           "jawOpen",
    "mouthClose",        "mouthFunnel",        "mouthPucker",
    "mouthLeft",         "mouthRight",         "mouthSmileLeft",
    "mouthSmileRight",   "mouthFrownLeft",     "mouthFrownRight",
    "mouthDimpleLeft",   "mouthDimpleRight",   "mouthStretchLeft",
    "mouthStretchRight", "mouthRollLower",     "mouthRollUpper",
    "mouthShrugLower",   "mouthShrugUpper",    "mouthPressLeft",
    "mouthPressRight",   "mouthLowerDownLeft", "mouthLowerDownRight",
    "mouthUpperUpLeft",  "mouthUpperUpRight",  "browDownLeft",
    "browDownRight",     "browInnerUp",        "browOuterUpLeft",
    "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",
    "cheekSquintRight",  "noseSneerLeft",      "noseSneerRight",
    "tongueOut"};

// The values after the controls in Live Link Face's files and packets.
inline constexpr std::array<std::string_view, kRotationCount> kRotationNames = {
    "HeadYaw",     "HeadPitch",   "HeadRoll",      "LeftEyeYaw",  "LeftEyePitch",
    "LeftEyeRoll", "RightEyeYaw", "RightEyePitch", "RightEyeRoll"};

// MediaPipe's kBlendshapeNames (face_blendshapes_graph.cc): alphabetical, with a neutral entry,
// without tongueOut.
inline constexpr std::array<std::string_view, 52> kMediaPipeNames = {
    "_neutral",         "browDownLeft",      "browDownRight",      "browInnerUp",
    "browOuterUpLeft",  "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",
    "cheekSquintRight", "eyeBlinkLeft",      "eyeBlinkRight",      "eyeLookDownLeft",
    "eyeLookDownRight", "eyeLookInLeft",     "eyeLookInRight",     "eyeLookOutLeft",
    "eyeLookOutRight",  "eyeLookUpLeft",     "eyeLookUpRight",     "eyeSquintLeft",
    "eyeSquintRight",   "eyeWideLeft",       "eyeWideRight",       "jawForward",
    "jawLeft",          "jawOpen",           "jawRight",           "mouthClose",
    "mouthDimpleLeft",  "mouthDimpleRight",  "mouthFrownLeft",     "mouthFrownRight",
    "mouthFunnel",      "mouthLeft",         "mouthLowerDownLeft", "mouthLowerDownRight",
    "mouthPressLeft",   "mouthPressRight",   "mouthPucker",        "mouthRight",
    "mouthRollLower",   "mouthRollUpper",    "mouthShrugLower",    "mouthShrugUpper",
    "mouthSmileLeft",   "mouthSmileRight",   "mouthStretchLeft",   "mouthStretchRight",
    "mouthUpperUpLeft", "mouthUpperUpRight", "noseSneerLeft",      "noseSneerRight"};

// Roblox's FacsActionUnit in the order of the enum: `NoseWrinkler` precedes InnerBrowRaiser on the
// left, and follows it on the right.
inline constexpr std::array<std::string_view, kFacsCount> kFacsNames = {"ChinRaiserUpperLip",
                                                                        "ChinRaiser",
                                                                        "FlatPucker",
                                                                        "Funneler",
                                                                        "LowerLipSuck",
                                                                        "LipPresser",
                                                                        "LipsTogether",
                                                                        "MouthLeft",
                                                                        "MouthRight",
                                                                        "Pucker",
                                                                        "UpperLipSuck",
                                                                        "LeftCheekPuff",
                                                                        "LeftDimpler",
                                                                        "LeftLipCornerDown",
                                                                        "LeftLowerLipDepressor",
                                                                        "LeftLipCornerPuller",
                                                                        "LeftLipStretcher",
                                                                        "LeftUpperLipRaiser",
                                                                        "RightCheekPuff",
                                                                        "RightDimpler",
                                                                        "RightLipCornerDown",
                                                                        "RightLowerLipDepressor",
                                                                        "RightLipCornerPuller",
                                                                        "RightLipStretcher",
                                                                        "RightUpperLipRaiser",
                                                                        "JawDrop",
                                                                        "JawLeft",
                                                                        "JawRight",
                                                                        "Corrugator",
                                                                        "LeftBrowLowerer",
                                                                        "LeftOuterBrowRaiser",
                                                                        "LeftNoseWrinkler",
                                                                        "LeftInnerBrowRaiser",
                                                                        "RightBrowLowerer",
                                                                        "RightOuterBrowRaiser",
                                                                        "RightInnerBrowRaiser",
                                                                        "RightNoseWrinkler",
                                                                        "EyesLookDown",
                                                                        "EyesLookLeft",
                                                                        "EyesLookUp",
                                                                        "EyesLookRight",
                                                                        "LeftCheekRaiser",
                                                                        "LeftEyeUpperLidRaiser",
                                                                        "LeftEyeClosed",
                                                                        "RightCheekRaiser",
                                                                        "RightEyeUpperLidRaiser",
                                                                        "RightEyeClosed",
                                                                        "TongueDown",
                                                                        "TongueOut",
                                                                        "TongueUp"};

// The units of Roblox's level of detail 1 (FACSDataLod).
inline constexpr std::array<std::string_view, 6> kFacsLevel1Names = {
    "JawDrop", "RightEyeClosed", "LeftEyeClosed", "RightLipCornerPuller", "LeftLipCornerPuller",
    "Pucker"};

// Visemes of OVR LipSync and OpenXR, in their order. Ready Player Me prepends "viseme_" and names
// E, ih, oh, ou E, I, O, U.
inline constexpr std::array<std::string_view, kVisemeCount> kVisemeNames = {
    "sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "ih", "oh", "ou"};
inline constexpr std::array<std::string_view, kVisemeCount> kReadyPlayerMeNames = {
    "viseme_sil", "viseme_PP", "viseme_FF", "viseme_TH", "viseme_DD",
    "viseme_kk",  "viseme_CH", "viseme_SS", "viseme_nn", "viseme_RR",
    "viseme_aa",  "viseme_E",  "viseme_I",  "viseme_O",  "viseme_U"};

// Expressions of avatars: VRM 0.x as in the VMC protocol, and VRM 1.0.
inline constexpr std::array<std::string_view, 17> kVrm0Names = {
    "Neutral", "A",   "I",      "U",        "E",        "O",         "Blink",   "Joy",    "Angry",
    "Sorrow",  "Fun", "LookUp", "LookDown", "LookLeft", "LookRight", "Blink_L", "Blink_R"};
inline constexpr std::array<std::string_view, 18> kVrm1Names = {
    "happy",      "angry",  "sad",      "relaxed",  "surprised", "aa",
    "ih",         "ou",     "ee",       "oh",       "blink",     "blinkLeft",
    "blinkRight", "lookUp", "lookDown", "lookLeft", "lookRight", "neutral"};

// Mouth shapes of Rhubarb Lip Sync; X is rest.
inline constexpr std::string_view kMouthShapes = "ABCDEFGHX";

[[nodiscard]] constexpr char to_lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

[[nodiscard]] constexpr bool same_name(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) {
    return false;
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (to_lower(a[i]) != to_lower(b[i])) {
      return false;
    }
  }
  return true;
}

// The index of a name in a vocabulary, ignoring case; the size of the vocabulary if it is absent.
template <std::size_t N>
[[nodiscard]] constexpr std::size_t index_of(std::string_view name,
                                             const std::array<std::string_view, N>& names) {
  std::size_t i = 0;
  while (i < N && !same_name(name, names[i])) {
    ++i;
  }
  return i;
}

// The index of an existing name; other names do not compile.
consteval std::size_t control(std::string_view name) {
  std::size_t i = 0;
  while (kArkitNames[i] != name) {
    ++i;
  }
  return i;
}

consteval std::size_t facs_unit(std::string_view name) {
  std::size_t i = 0;
  while (kFacsNames[i] != name) {
    ++i;
  }
  return i;
}

}  // namespace mien::formats
