// Tests of symmetrizing pairs of controls.
#include "tracker/decoders/symmetry.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace mien::tests {
namespace {

using namespace mien::tracker;

using Controls = std::array<float, kControls>;

constexpr std::uint64_t kAll = ~std::uint64_t{0};
constexpr std::size_t kLeft = control_named("mouthSmileLeft");
constexpr std::size_t kRight = control_named("mouthSmileRight");

Controls smile(float left, float right) {
  Controls controls{};
  controls[kLeft] = left;
  controls[kRight] = right;
  return controls;
}

Controls symmetrized(Controls controls, std::uint64_t supported = kAll) {
  symmetrize(supported, controls);
  return controls;
}

TEST(Symmetry, LargeDifferencesStay) {
  EXPECT_EQ(symmetrized(smile(0.7f, 0.6f)), smile(0.7f, 0.6f));
  EXPECT_EQ(symmetrized(smile(0.0f, kSymmetryThreshold)), smile(0.0f, kSymmetryThreshold));
}

TEST(Symmetry, SmallDifferencesShrinkAroundTheirMean) {
  for (const float difference : {-0.04f, -0.01f, 0.0f, 0.02f, 0.049f}) {
    const Controls result = symmetrized(smile(0.5f + difference / 2, 0.5f - difference / 2));
    EXPECT_NEAR(result[kLeft] + result[kRight], 1.0f, 1e-6f);
    EXPECT_NEAR(result[kLeft] - result[kRight],
                difference * std::abs(difference) / kSymmetryThreshold, 1e-6f);
  }
}

TEST(Symmetry, ControlsChangeLittleAndStayInRange) {
  for (int thousandth = 0; thousandth <= 1000; ++thousandth) {
    const float right = static_cast<float>(thousandth) / 1000;
    const Controls result = symmetrized(smile(0.01f, right));
    EXPECT_LE(std::abs(result[kLeft] - 0.01f), kSymmetryThreshold / 8 + 1e-6f);
    EXPECT_LE(std::abs(result[kRight] - right), kSymmetryThreshold / 8 + 1e-6f);
    EXPECT_GE(result[kLeft], 0.0f);
    EXPECT_GE(result[kRight], 0.0f);
  }
}

TEST(Symmetry, ControlsNeverLeaveZeroToOne) {
  float right = kSymmetryThreshold;
  while (right > 0.04f) {
    right = std::nextafter(right, 0.0f);
    ASSERT_GE(symmetrized(smile(0.0f, right))[kLeft], 0.0f) << right;
    ASSERT_LE(symmetrized(smile(1.0f, 1.0f - right))[kLeft], 1.0f) << right;
    right -= 1e-7f;
  }
}

TEST(Symmetry, AppliesToPairsOnly) {
  for (std::size_t i = 0; i < kControls; ++i) {
    Controls controls{};
    controls[i] = 0.02f;
    const Controls result = symmetrized(controls);
    const std::string_view name = kControlNames[i];
    const bool paired = (name.ends_with("Left") || name.ends_with("Right")) &&
                        !name.starts_with("jaw") && !name.starts_with("eyeLookIn") &&
                        !name.starts_with("eyeLookOut") && name != "mouthLeft" &&
                        name != "mouthRight";
    EXPECT_EQ(result[i] != 0.02f, paired) << name;
  }
}

TEST(Symmetry, IgnoresPairsThatAreNotSupported) {
  EXPECT_EQ(symmetrized(smile(0.02f, 0.0f), kAll & ~(std::uint64_t{1} << kRight)),
            smile(0.02f, 0.0f));
}

}  // namespace
}  // namespace mien::tests
