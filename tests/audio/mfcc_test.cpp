// Compares MFCCs with those of tests/golden/audio/make_mfcc.py, which implements the definition.
#include "audio/mfcc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernels/tier.h"
#include "tests/audio/golden.h"
#include "tests/kernels/every_tier.h"

namespace mien::tests {
namespace {

using audio::kCoefficients;
using audio::kWindowSamples;
using audio::Mfcc;

constexpr std::size_t kSignals = 5;
constexpr std::size_t kWindows = 15;
constexpr double kTolerance = 1e-4;  // of a window's largest coefficient

using Window = std::span<const float, kWindowSamples>;
using Coefficients = std::array<float, kCoefficients>;

class MfccOfTier : public testing::TestWithParam<std::uint32_t> {
 protected:
  void SetUp() override { ASSERT_TRUE(mfcc_.init(GetParam())); }

  Coefficients analyse(const float* samples) {
    Coefficients out;
    mfcc_.analyse(Window(samples, kWindowSamples), out);
    return out;
  }

  Mfcc mfcc_;
};

TEST_P(MfccOfTier, MatchTheDefinition) {
  const std::vector<float> input = golden("mfcc_input.f32"), expected = golden("mfcc_output.f32");
  ASSERT_EQ(input.size(), kSignals * kWindows * kWindowSamples);
  ASSERT_EQ(expected.size(), kSignals * kWindows * kCoefficients);
  for (std::size_t w = 0; w < kSignals * kWindows; ++w) {
    if (w % kWindows == 0) {
      mfcc_.reset();
    }
    const Coefficients got = analyse(input.data() + w * kWindowSamples);
    const float* want = expected.data() + w * kCoefficients;
    double largest = 0.0;
    for (std::size_t i = 0; i < kCoefficients; ++i) {
      largest = std::max(largest, std::abs(static_cast<double>(want[i])));
    }
    for (std::size_t i = 0; i < kCoefficients; ++i) {
      EXPECT_NEAR(got[i], want[i], kTolerance * largest) << "window " << w << ", coefficient " << i;
    }
  }
}

TEST_P(MfccOfTier, ResetDiscardsThePreviousWindow) {
  const std::vector<float> input = golden("mfcc_input.f32");
  const Coefficients first = analyse(input.data());
  EXPECT_NE(analyse(input.data()), first);
  mfcc_.reset();
  EXPECT_EQ(analyse(input.data()), first);
}

// The DCT is orthonormal and coefficient 0 has no lifter: it is the sum of the bands / sqrt(26).
TEST_P(MfccOfTier, LogMelIsTheInputOfTheDct) {
  const std::vector<float> input = golden("mfcc_input.f32");
  for (std::size_t w = 0; w < kSignals * kWindows; ++w) {
    const Coefficients got = analyse(input.data() + w * kWindowSamples);
    double sum = 0.0;
    for (const float band : mfcc_.log_mel()) {
      sum += static_cast<double>(band);
    }
    EXPECT_NEAR(sum / std::sqrt(26.0), static_cast<double>(got[0]), 1e-3) << w;
  }
}

TEST_P(MfccOfTier, AreFiniteForSilenceAndTheLargestSamples) {
  for (const float level : {0.0f, 1e-40f, 1.0f, -1.0f}) {
    const std::vector<float> samples(kWindowSamples, level);
    for (const float value : analyse(samples.data())) {
      EXPECT_TRUE(std::isfinite(value)) << level;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Tiers, MfccOfTier, testing::ValuesIn(every_tier()));

}  // namespace
}  // namespace mien::tests
