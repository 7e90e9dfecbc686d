// All 65536 halves, and floats around every rounding boundary, in every tier.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "kernels/families.h"
#include "kernels/registry.h"

namespace mien::tests {
namespace {

using namespace kernels;  // NOLINT: the test is about nothing else

template <class Args>
std::vector<Kernel<Args>> kernels_here() {
  std::vector<Kernel<Args>> found;
  for (std::uint32_t tier = 0; tier < kTierCount; ++tier) {
    if ((detect_cpu() & (1u << tier)) != 0) {
      found.push_back(find<Args>(1u << tier));
    }
  }
  return found;
}

double value_of(std::uint16_t half) {
  const int exponent = (half >> 10) & 31;
  const double fraction = half & 1023;
  const double magnitude =
      exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return (half & 0x8000) != 0 ? -magnitude : magnitude;
}

TEST(Half, EveryFiniteHalfWidensExactlyAndComesBack) {
  std::vector<std::uint16_t> halves;
  for (int i = 0; i < 65536; ++i) {
    if ((i & 0x7C00) != 0x7C00) {
      halves.push_back(static_cast<std::uint16_t>(i));
    }
  }
  const auto n = static_cast<std::int32_t>(halves.size());
  for (const auto widen : kernels_here<HalfToFloatArgs>()) {
    std::vector<float> wide(halves.size());
    widen({halves.data(), wide.data(), n});
    for (std::size_t i = 0; i < halves.size(); ++i) {
      ASSERT_EQ(static_cast<double>(wide[i]), value_of(halves[i])) << halves[i];
    }
    for (const auto narrow : kernels_here<FloatToHalfArgs>()) {
      std::vector<std::uint16_t> back(halves.size());
      narrow({wide.data(), back.data(), n});
      ASSERT_EQ(back, halves);
    }
  }
}

TEST(Half, TiesGoToEvenAndTheRestToTheNearest) {
  std::vector<float> floats;
  for (std::uint32_t half = 0; half < 0x7BFFu; ++half) {
    const double low = value_of(static_cast<std::uint16_t>(half));
    const double high = value_of(static_cast<std::uint16_t>(half + 1));
    const auto middle = static_cast<float>((low + high) / 2);
    floats.push_back(middle);
    floats.push_back(std::nextafter(middle, 1e9f));
    floats.push_back(-std::nextafter(middle, -1e9f));
  }
  floats.insert(floats.end(),
                {65504.0f, 65519.9f, 65520.0f, 1e30f, -1e30f, 1e-30f, INFINITY, -INFINITY});
  const auto n = static_cast<std::int32_t>(floats.size());
  const auto tiers = kernels_here<FloatToHalfArgs>();
  std::vector<std::uint16_t> want(floats.size());
  tiers[0]({floats.data(), want.data(), n});
  for (std::uint32_t half = 0; half < 0x7BFFu; ++half) {
    ASSERT_EQ(want[3 * half], half + (half & 1u));
    ASSERT_EQ(want[3 * half + 1], half + 1);
    ASSERT_EQ(want[3 * half + 2], (half | 0x8000u));
  }
  for (const auto narrow : tiers) {
    std::vector<std::uint16_t> got(floats.size());
    narrow({floats.data(), got.data(), n});
    ASSERT_EQ(got, want);
  }
}

}  // namespace
}  // namespace mien::tests
