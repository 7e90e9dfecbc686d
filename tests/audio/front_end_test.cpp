// Tests of the conversion of samples to features: formats, invalid samples, blocks, offset, time.
#include "audio/front_end.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "apps/conformance/random_values.h"
#include "audio/pcm.h"
#include "kernels/tier.h"

namespace mien::tests {
namespace {

using audio::FrontEnd;
using audio::Pcm;
using audio::SampleFormat;
using audio::to_mono;
using Features = std::array<float, FrontEnd::kFeatures>;

std::vector<float> noise(std::size_t samples, float level = 0.3f, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(-level, level);
  std::vector<float> out(samples);
  std::generate(out.begin(), out.end(), [&] { return value(random); });
  return out;
}

void feed(FrontEnd& front_end, std::span<const float> samples, std::vector<Features>& out) {
  while (!samples.empty()) {
    samples = samples.subspan(front_end.take(samples));
    for (Features features; front_end.fetch(features);) {
      out.push_back(features);
    }
  }
}

std::vector<Features> features_of(std::span<const float> samples, std::int32_t rate,
                                  const std::function<std::size_t()>& block) {
  FrontEnd front_end;
  EXPECT_TRUE(front_end.init(kernels::detect_cpu()));
  front_end.start(rate);
  std::vector<Features> out;
  while (!samples.empty()) {
    const std::size_t count = std::min(samples.size(), block());
    feed(front_end, samples.first(count), out);
    samples = samples.subspan(count);
  }
  return out;
}

std::vector<Features> features_of(std::span<const float> samples, std::int32_t rate = 16000) {
  return features_of(samples, rate, [] { return std::size_t{100000}; });
}

TEST(Pcm, AllLayoutsGiveTheSameSamples) {
  constexpr std::size_t kFrames = 50;
  std::vector<float> left(kFrames), right(kFrames), both;
  std::vector<std::int16_t> shorts;
  for (std::size_t i = 0; i < kFrames; ++i) {
    left[i] = static_cast<float>(static_cast<int>(i) * 600 - 15000) / 32768.0f;
    right[i] = static_cast<float>(20000 - static_cast<int>(i) * 700) / 32768.0f;
    for (const float sample : {left[i], right[i]}) {
      both.push_back(sample);
      shorts.push_back(static_cast<std::int16_t>(sample * 32768.0f));
    }
  }
  const Pcm layouts[] = {
      {SampleFormat::kFloat32, true, 2, kFrames, {left.data(), right.data()}},
      {SampleFormat::kFloat32, false, 2, kFrames, {both.data()}},
      {SampleFormat::kInt16, false, 2, kFrames, {shorts.data()}},
  };
  for (const Pcm& pcm : layouts) {
    std::vector<float> mono(kFrames - 7);
    to_mono(pcm, 7, mono);
    for (std::size_t i = 0; i < mono.size(); ++i) {
      EXPECT_FLOAT_EQ(mono[i], (left[i + 7] + right[i + 7]) / 2) << i;
    }
  }
}

TEST(Pcm, InvalidSamplesBecomeSilenceOrFullScale) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float given[] = {std::nanf(""), kInfinity, -kInfinity, 7.0f, -7.0f, 1e-40f, 0.5f};
  const float expected[] = {0.0f, 0.0f, 0.0f, 1.0f, -1.0f, 0.0f, 0.5f};
  std::vector<float> mono(std::size(given));
  to_mono({SampleFormat::kFloat32, false, 1, std::size(given), {given}}, 0, mono);
  EXPECT_TRUE(std::equal(mono.begin(), mono.end(), expected));
}

TEST(FrontEnd, FeaturesDoNotDependOnBlockSize) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    conformance::RandomValues random(seed);
    const std::int32_t rates[] = {8000, 11025, 16000, 22050, 44100, 48000, 96000, 192000};
    const std::int32_t rate =
        seed % 2 == 0 ? rates[seed / 2 % std::size(rates)] : random.between(8000, 192000);
    const std::vector<float> sound = noise(static_cast<std::size_t>(rate / 5), 0.5f, seed);
    const int max_block = seed % 10 == 0 ? 1 : random.between(1, 3000);
    ASSERT_EQ(features_of(sound, rate,
                          [&] { return static_cast<std::size_t>(random.between(1, max_block)); }),
              features_of(sound, rate))
        << "seed " << seed << ", rate " << rate;
  }
}

TEST(FrontEnd, KeepsFiveWindowsAndStartsWithSilence) {
  const std::vector<Features> steps = features_of(noise(16000));
  ASSERT_GE(steps.size(), 60u);
  const std::vector<Features> quiet = features_of(std::vector<float>(16000));
  constexpr std::size_t kOlder = FrontEnd::kFeatures - audio::kCoefficients;
  EXPECT_TRUE(std::equal(steps[0].begin(), steps[0].begin() + kOlder, quiet[9].begin()));
  for (std::size_t k = 1; k < steps.size(); ++k) {
    EXPECT_TRUE(std::equal(steps[k].begin(), steps[k].begin() + kOlder,
                           steps[k - 1].begin() + audio::kCoefficients));
  }
}

TEST(FrontEnd, RemovesAConstantOffset) {
  const std::vector<float> sound = noise(32000);
  std::vector<float> shifted = sound;
  for (float& sample : shifted) {
    sample += 0.4f;
  }
  const Features clean = features_of(sound).back(), moved = features_of(shifted).back();
  for (std::size_t i = 0; i < clean.size(); ++i) {
    EXPECT_NEAR(clean[i], moved[i], 0.02f) << i;
  }
}

TEST(FrontEnd, FeaturesDoNotDependOnTheRate) {
  const auto tones = [](std::int32_t rate) {
    std::vector<float> out(static_cast<std::size_t>(rate));
    for (std::size_t n = 0; n < out.size(); ++n) {
      const double t = 2.0 * std::numbers::pi * static_cast<double>(n) / rate;
      for (double hz = 150.0; hz < 3100.0; hz += 150.0) {
        out[n] += static_cast<float>(0.04 * std::sin(hz * t + hz));
      }
    }
    return out;
  };
  const std::vector<Features> want = features_of(tones(16000));
  for (const std::int32_t rate : {44100, 48000, 37813}) {
    const std::vector<Features> got = features_of(tones(rate), rate);
    for (std::size_t k = 10; k < std::min(got.size(), want.size()); ++k) {
      // Only the first coefficients: the last ones depend on bands that contain only rounding
      // errors.
      for (std::size_t i = 0; i < 6; ++i) {
        ASSERT_NEAR(got[k][i], want[k][i], 0.6f) << rate << " step " << k << " coefficient " << i;
      }
    }
  }
}

TEST(FrontEnd, StepTimeMatchesAClick) {
  constexpr std::size_t kAt = 8000;
  std::vector<float> sound(16000);
  sound[kAt] = 1.0f;
  const std::vector<Features> steps = features_of(sound);
  const Features quiet = steps[10];
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (std::abs(steps[k][2 * audio::kCoefficients] - quiet[0]) > 1.0f) {  // the centre window
      sum += FrontEnd::seconds_of_step(static_cast<std::int64_t>(k));
      count += 1.0;
    }
  }
  ASSERT_GT(count, 0.0);
  EXPECT_NEAR(sum / count, 0.5, 0.02);
}

}  // namespace
}  // namespace mien::tests
