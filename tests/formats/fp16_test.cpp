// Tests of fp16 conversions.
#include "formats/fp16.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace mien::formats {
namespace {

// By definition: sign, 5 bits of exponent, 10 bits of fraction.
double value_of(std::uint32_t half) {
  const int exponent = static_cast<int>(half >> 10 & 31);
  const double fraction = half & 1023;
  const double magnitude =
      exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return (half & 0x8000) != 0 ? -magnitude : magnitude;
}

constexpr bool is_finite(std::uint32_t half) { return (half & 0x7c00) != 0x7c00; }

TEST(Fp16, AllFiniteHalvesRoundTrip) {
  for (std::uint32_t half = 0; half < 0x10000; ++half) {
    if (is_finite(half)) {
      const float value = float_from_fp16(static_cast<std::uint16_t>(half));
      EXPECT_EQ(value, value_of(half)) << half;
      EXPECT_EQ(fp16_from_float(value), half) << half;
    }
  }
}

TEST(Fp16, RoundsToNearestAndTiesToEven) {
  for (std::uint32_t half = 0; half + 1 < 0x7c00; ++half) {
    const auto below = static_cast<float>(value_of(half));
    const auto above = static_cast<float>(value_of(half + 1));
    const float middle = (below + above) / 2;  // exact: 12 bits
    EXPECT_EQ(fp16_from_float(middle), half % 2 == 0 ? half : half + 1) << half;
    EXPECT_EQ(fp16_from_float(std::nextafter(middle, 0.0f)), half) << half;
    EXPECT_EQ(fp16_from_float(std::nextafter(middle, 1e9f)), half + 1) << half;
    EXPECT_EQ(fp16_from_float(-middle), 0x8000 | fp16_from_float(middle)) << half;
  }
}

TEST(Fp16, TooLargeIsInfinityAndNanStays) {
  EXPECT_EQ(fp16_from_float(65519.996f), 0x7bff);
  EXPECT_EQ(fp16_from_float(65520.0f), 0x7c00);
  EXPECT_EQ(fp16_from_float(-std::numeric_limits<float>::max()), 0xfc00);
  EXPECT_EQ(fp16_from_float(-std::numeric_limits<float>::infinity()), 0xfc00);
  EXPECT_EQ(fp16_from_float(std::numeric_limits<float>::quiet_NaN()) & 0x7e00, 0x7e00);
  EXPECT_TRUE(std::isinf(float_from_fp16(0x7c00)));
  EXPECT_TRUE(std::isnan(float_from_fp16(0x7e00)));
  EXPECT_EQ(fp16_from_float(1e-40f), 0);
}

}  // namespace
}  // namespace mien::formats
