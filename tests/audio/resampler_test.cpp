// Tests of the resampler: passband, stopband, block sizes and the number of samples.
#include "audio/resampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include "apps/conformance/random_values.h"
#include "kernels/tier.h"

namespace mien::tests {
namespace {

using audio::Resampler;

constexpr double kOutputRate = 16000.0;
constexpr std::int32_t kRates[] = {8000,  11025, 12000, 16000, 16001, 22050, 24000,
                                   32000, 37813, 44100, 48000, 88200, 96000, 192000};

std::vector<float> tone(double hz, std::int32_t rate, std::size_t samples) {
  std::vector<float> out(samples);
  for (std::size_t n = 0; n < samples; ++n) {
    out[n] =
        static_cast<float>(std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(n) / rate));
  }
  return out;
}

std::vector<float> resampled(std::span<const float> input, std::int32_t rate,
                             const std::function<std::size_t()>& block) {
  Resampler resampler;
  EXPECT_TRUE(resampler.init(kernels::detect_cpu()));
  resampler.start(rate);
  std::vector<float> out;
  while (!input.empty()) {
    const std::size_t taken = resampler.take(input.first(std::min(input.size(), block())));
    EXPECT_GT(taken, 0u);
    input = input.subspan(taken);
    for (float sample; resampler.fetch(sample);) {
      out.push_back(sample);
    }
  }
  return out;
}

std::vector<float> resampled(std::span<const float> input, std::int32_t rate) {
  return resampled(input, rate, [] { return std::size_t{4096}; });
}

double decibel(double amplitude) { return 20.0 * std::log10(amplitude + 1e-12); }

// Largest value after the filter's transient.
double largest(const std::vector<float>& values) {
  double found = 0.0;
  for (std::size_t i = 100; i < values.size(); ++i) {
    found = std::max(found, std::abs(static_cast<double>(values[i])));
  }
  return found;
}

TEST(Resampler, PassesTonesUnchangedAndInTime) {
  for (const std::int32_t rate : kRates) {
    const double half = std::min<double>(rate, kOutputRate) / 2;
    for (const double fraction : {0.02, 0.1, 0.35, 0.6, 0.8}) {
      const double hz = fraction * half;
      const std::vector<float> got =
          resampled(tone(hz, rate, static_cast<std::size_t>(rate / 4)), rate);
      ASSERT_GT(got.size(), 3800u) << rate;
      const std::vector<float> want = tone(hz, 16000, got.size());
      std::vector<float> error(got.size());
      for (std::size_t i = 0; i < got.size(); ++i) {
        error[i] = got[i] - want[i];
      }
      EXPECT_LT(decibel(largest(error)), -78.0) << rate << " Hz, tone of " << hz;
    }
  }
}

TEST(Resampler, AttenuatesAliases) {
  for (const std::int32_t rate : kRates) {
    for (double hz = 8000.0; hz < rate / 2.0; hz *= 1.07) {
      const std::vector<float> got =
          resampled(tone(hz, rate, static_cast<std::size_t>(rate / 8)), rate);
      EXPECT_LT(decibel(largest(got)), -80.0) << rate << " Hz, tone of " << hz;
    }
  }
}

TEST(Resampler, OutputDoesNotDependOnBlockSize) {
  conformance::RandomValues random(1);
  for (const std::int32_t rate : kRates) {
    const std::vector<float> input = random.plain(20000);
    const std::vector<float> whole = resampled(input, rate);
    for (int round = 0; round < 5; ++round) {
      EXPECT_EQ(
          resampled(input, rate, [&] { return static_cast<std::size_t>(random.between(1, 700)); }),
          whole)
          << rate;
    }
    EXPECT_EQ(resampled(input, rate, [] { return std::size_t{1}; }), whole) << rate;
  }
}

TEST(Resampler, SecondStreamMatchesTheFirst) {
  for (const std::int32_t rate : {11025, 44100, 37813}) {
    const std::vector<float> input = tone(440.0, rate, 1000);
    Resampler resampler;
    ASSERT_TRUE(resampler.init(kernels::detect_cpu()));
    std::vector<float> streams[2];
    for (std::vector<float>& out : streams) {
      resampler.start(rate);
      ASSERT_EQ(resampler.take(input), input.size());
      for (float sample; resampler.fetch(sample);) {
        out.push_back(sample);
      }
    }
    EXPECT_EQ(streams[0], streams[1]) << rate;
  }
}

TEST(Resampler, OutputsTheExactNumberOfSamples) {
  for (const std::int32_t rate : {11025, 44100, 37813}) {
    const std::vector<float> minute(static_cast<std::size_t>(60 * rate), 0.5f);
    Resampler resampler;
    ASSERT_TRUE(resampler.init(kernels::detect_cpu()));
    resampler.start(rate);
    const double delay = resampler.delay_seconds() * kOutputRate;
    EXPECT_NEAR(static_cast<double>(resampled(minute, rate).size()), 60 * kOutputRate - delay, 1.0);
  }
}

TEST(Resampler, ConstantStaysConstant) {
  for (const std::int32_t rate : kRates) {
    const std::vector<float> got =
        resampled(std::vector<float>(static_cast<std::size_t>(rate / 4), 0.7f), rate);
    for (std::size_t i = 100; i < got.size(); ++i) {
      ASSERT_NEAR(got[i], 0.7f, 1e-5f) << rate;
    }
  }
}

}  // namespace
}  // namespace mien::tests
