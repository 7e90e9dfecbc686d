// The mouths that visemes stand for, and the visemes and mouth shapes of a mouth.
#include "formats/vocabulary/visemes.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mien::formats {
namespace {

using Visemes = std::array<double, kVisemeCount>;
using Controls = std::array<double, kControlCount>;
using Values = std::vector<std::pair<std::string, double>>;

Visemes visemes_at(const Values& values) {
  Visemes made{};
  for (const auto& [name, value] : values) {
    made[index_of(name, kVisemeNames)] = value;
  }
  return made;
}

// A name without a side stands for both; other controls of the mouth are at rest.
Controls mouth_of(const Values& values) {
  Controls made = controls_of_visemes(Visemes{});
  for (const auto& [name, value] : values) {
    for (const std::string side : {"", "Left", "Right"}) {
      const std::size_t control = index_of(name + side, kArkitNames);
      if (control < kControlCount) {
        made[control] = value;
      }
    }
  }
  return made;
}

void expect_mouth(const Controls& made, const Controls& wanted, const std::string& what) {
  for (std::size_t i = 0; i < kControlCount; ++i) {
    EXPECT_EQ(driven(made[i]), driven(wanted[i])) << what << kArkitNames[i];
    EXPECT_NEAR(or_zero(made[i]), or_zero(wanted[i]), 1e-12) << what << kArkitNames[i];
  }
}

TEST(Visemes, EachIsAMouth) {
  const std::vector<std::pair<std::string, Values>> poses = {
      {"sil", {}},
      {"PP",
       {{"mouthPress", 0.5},
        {"mouthRollLower", 0.35},
        {"mouthRollUpper", 0.35},
        {"mouthClose", 0.1}}},
      {"FF", {{"mouthRollLower", 0.55}, {"mouthUpperUp", 0.3}, {"jawOpen", 0.06}}},
      {"TH", {{"tongueOut", 0.5}, {"jawOpen", 0.18}, {"mouthLowerDown", 0.2}}},
      {"DD", {{"jawOpen", 0.14}, {"mouthLowerDown", 0.35}, {"mouthUpperUp", 0.3}}},
      {"kk", {{"jawOpen", 0.26}, {"mouthStretch", 0.1}, {"mouthDimple", 0.35}}},
      {"CH",
       {{"mouthFunnel", 0.5}, {"jawForward", 0.3}, {"mouthUpperUp", 0.25}, {"jawOpen", 0.08}}},
      {"SS", {{"mouthStretch", 0.45}, {"mouthLowerDown", 0.35}, {"jawOpen", 0.03}}},
      {"nn", {{"jawOpen", 0.16}, {"mouthShrugUpper", 0.3}, {"mouthLowerDown", 0.15}}},
      {"RR",
       {{"mouthPucker", 0.35}, {"mouthFunnel", 0.3}, {"jawOpen", 0.12}, {"mouthShrugLower", 0.3}}},
      {"aa", {{"jawOpen", 0.65}, {"mouthLowerDown", 0.2}, {"mouthUpperUp", 0.1}}},
      {"E",
       {{"jawOpen", 0.35},
        {"mouthSmile", 0.15},
        {"mouthStretch", 0.35},
        {"mouthDimple", 0.2},
        {"mouthUpperUp", 0.2}}},
      {"ih", {{"jawOpen", 0.2}, {"mouthSmile", 0.45}}},
      {"oh", {{"jawOpen", 0.42}, {"mouthFunnel", 0.5}, {"mouthPucker", 0.1}}},
      {"ou", {{"jawOpen", 0.14}, {"mouthPucker", 0.75}, {"mouthFunnel", 0.15}}}};
  ASSERT_EQ(poses.size(), kVisemeCount);
  for (const auto& [viseme, pose] : poses) {
    expect_mouth(controls_of_visemes(visemes_at({{viseme, 1.0}})), mouth_of(pose), viseme + " ");
  }
  expect_mouth(controls_of_visemes(visemes_at({{"aa", 0.5}, {"ih", 0.25}, {"sil", 0.25}})),
               mouth_of({{"jawOpen", 0.375},
                         {"mouthLowerDown", 0.1},
                         {"mouthUpperUp", 0.05},
                         {"mouthSmile", 0.1125}}),
               "mixed ");
  expect_mouth(controls_of_visemes(visemes_at({{"aa", 1.0}, {"oh", 1.0}})),
               mouth_of({{"jawOpen", 1.0},
                         {"mouthLowerDown", 0.2},
                         {"mouthUpperUp", 0.1},
                         {"mouthFunnel", 0.5},
                         {"mouthPucker", 0.1}}),
               "at most 1 ");
}

TEST(Visemes, OnlyControlsOfTheMouthAreSet) {
  std::size_t count = 0;
  for (const double control : controls_of_visemes(Visemes{})) {
    count += driven(control) ? 1 : 0;
  }
  EXPECT_EQ(count, 22u);
  Visemes none{};
  none.fill(kNoNumber);
  for (const double control : controls_of_visemes(none)) {
    EXPECT_FALSE(driven(control));
  }
  none[10] = 1.0;
  EXPECT_NEAR(controls_of_visemes(none)[index_of("jawOpen", kArkitNames)], 0.65, 1e-12)
      << "one of them is enough";
}

TEST(Visemes, OneSideOfTheMouthCountsHalf) {
  Controls controls = mouth_of({{"jawOpen", 0.2}, {"mouthSmile", 0.45}});
  controls[index_of("mouthSmileLeft", kArkitNames)] = 0.9;
  controls[index_of("mouthSmileRight", kArkitNames)] = kNoNumber;
  EXPECT_NEAR(visemes_of(controls)[index_of("ih", kVisemeNames)], 1.0, 1e-9);
}

TEST(Visemes, SilenceIsTheRemainderAndLargerSumsAreNormalized) {
  const Visemes half = visemes_of(mouth_of({{"jawOpen", 0.1}, {"mouthSmile", 0.225}}));
  EXPECT_NEAR(half[index_of("ih", kVisemeNames)], 0.5, 1e-9);
  EXPECT_NEAR(half[0], 0.5, 1e-9);
  const Visemes twice = visemes_of(mouth_of({{"jawOpen", 0.4}, {"mouthSmile", 0.9}}));
  EXPECT_NEAR(twice[index_of("ih", kVisemeNames)], 1.0, 1e-9);
  EXPECT_EQ(twice[0], 0.0);
}

TEST(Visemes, TheLeadingControlOfAPose) {
  const std::string_view leading[] = {
      "mouthPressLeft",  "mouthRollLower", "tongueOut",        "mouthLowerDownLeft",
      "mouthDimpleLeft", "mouthFunnel",    "mouthStretchLeft", "mouthShrugUpper",
      "mouthPucker",     "jawOpen",        "jawOpen",          "mouthSmileLeft",
      "mouthFunnel",     "mouthPucker"};
  for (std::size_t i = 1; i < kVisemeCount; ++i) {
    const auto [left, right] = leading_controls(i);
    EXPECT_EQ(kArkitNames[left], leading[i - 1]) << i;
    EXPECT_EQ(right, kArkitNames[left].ends_with("Left") ? left + 1 : left) << i;
  }
  for (const std::size_t none : {std::size_t{0}, kVisemeCount}) {
    EXPECT_EQ(leading_controls(none), (std::array{kControlCount, kControlCount})) << none;
  }
}

TEST(Visemes, MouthShapesAreThoseOfTheStrongestViseme) {
  const std::string shapes = "XAGHBBBBBEDCBEF";
  for (std::size_t i = 0; i < kVisemeCount; ++i) {
    EXPECT_EQ(mouth_shape_of(visemes_at({{std::string(kVisemeNames[i]), 1.0}})), shapes[i])
        << kVisemeNames[i];
  }
  EXPECT_EQ(mouth_shape_of(visemes_at({{"sil", 0.75}, {"aa", 0.25}})), 'D');
  EXPECT_EQ(mouth_shape_of(visemes_at({{"sil", 0.76}, {"aa", 0.24}})), 'X');
  EXPECT_EQ(mouth_shape_of(visemes_at({{"PP", 0.3}, {"oh", 0.4}, {"ou", 0.3}})), 'E');
  EXPECT_EQ(mouth_shape_of(visemes_at({{"PP", 0.5}, {"ou", 0.5}})), 'A')
      << "the first of equal ones";
  EXPECT_EQ(mouth_shape_of(Visemes{}), 'X');
  const std::string names[] = {"PP", "DD", "E", "aa", "oh", "ou", "FF", "TH", "sil"};
  for (std::size_t i = 0; i < kMouthShapes.size(); ++i) {
    EXPECT_EQ(visemes_of_mouth_shape(kMouthShapes[i]), visemes_at({{names[i], 1.0}}))
        << kMouthShapes[i];
  }
  EXPECT_EQ(visemes_of_mouth_shape('Q'), visemes_at({{"sil", 1.0}})) << "no shape";
}

}  // namespace
}  // namespace mien::formats
