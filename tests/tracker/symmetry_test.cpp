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

Controls evened(Controls controls, std::uint64_t supported = kAll) {
  symmetrize(supported, controls);
  return controls;
}

TEST(Symmetry, LargeDifferencesStay) {
  EXPECT_EQ(evened(smile(0.7f, 0.6f)), smile(0.7f, 0.6f));
  EXPECT_EQ(evened(smile(0.0f, kSymmetryThreshold)), smile(0.0f, kSymmetryThreshold));
}

TEST(Symmetry, SmallDifferencesShrinkAroundTheirMean) {
  for (const float apart : {-0.04f, -0.01f, 0.0f, 0.02f, 0.049f}) {
    const Controls even = evened(smile(0.5f + apart / 2, 0.5f - apart / 2));
    EXPECT_NEAR(even[kLeft] + even[kRight], 1.0f, 1e-6f);
    EXPECT_NEAR(even[kLeft] - even[kRight], apart * std::abs(apart) / kSymmetryThreshold, 1e-6f);
  }
}

TEST(Symmetry, ControlsChangeLittleAndStayInRange) {
  for (int thousandth = 0; thousandth <= 1000; ++thousandth) {
    const float right = static_cast<float>(thousandth) / 1000;
    const Controls even = evened(smile(0.01f, right));
    EXPECT_LE(std::abs(even[kLeft] - 0.01f), kSymmetryThreshold / 8 + 1e-6f);
    EXPECT_LE(std::abs(even[kRight] - right), kSymmetryThreshold / 8 + 1e-6f);
    EXPECT_GE(even[kLeft], 0.0f);
    EXPECT_GE(even[kRight], 0.0f);
  }
}

TEST(Symmetry, ControlsNeverLeaveZeroToOne) {
  float right = kSymmetryThreshold;
  while (right > 0.04f) {
    right = std::nextafter(right, 0.0f);
    ASSERT_GE(evened(smile(0.0f, right))[kLeft], 0.0f) << right;
    ASSERT_LE(evened(smile(1.0f, 1.0f - right))[kLeft], 1.0f) << right;
    right -= 1e-7f;
  }
}

TEST(Symmetry, AppliesToPairsOnly) {
  for (std::size_t i = 0; i < kControls; ++i) {
    Controls controls{};
    controls[i] = 0.02f;
    const Controls even = evened(controls);
    const std::string_view name = kControlNames[i];
    const bool sided = (name.ends_with("Left") || name.ends_with("Right")) &&
                       !name.starts_with("jaw") && !name.starts_with("eyeLookIn") &&
                       !name.starts_with("eyeLookOut") && name != "mouthLeft" &&
                       name != "mouthRight";
    EXPECT_EQ(even[i] != 0.02f, sided) << name;
  }
}

TEST(Symmetry, IgnoresPairsThatAreNotSupported) {
  EXPECT_EQ(evened(smile(0.02f, 0.0f), kAll & ~(std::uint64_t{1} << kRight)), smile(0.02f, 0.0f));
}

}  // namespace
}  // namespace mien::tests
