// Sound at any rate -> what AudioNet hears: the MFCCs of five windows, once every 16 ms.
//
// Resampler -> high-pass of 20 Hz against a microphone's constant offset -> MFCC -> the last five
// windows, oldest first. Before the first window there was silence. Step k speaks of the middle of
// its windows, (256 k - 384) / 16000 s after the stream's first sample, and can be had 40 ms later
// plus the resampler's 2 ms.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "audio/mfcc.h"
#include "audio/resampler.h"

namespace mien::audio {

class FrontEnd {
 public:
  static constexpr std::size_t kWindows = 5;
  static constexpr std::size_t kFeatures = kWindows * kCoefficients;

  // False when no tier of `cpu_mask` runs here.
  [[nodiscard]] bool init(std::uint32_t cpu_mask);

  // Begins a stream of `input_rate` samples a second (see Resampler).
  void start(std::int32_t input_rate);

  // Takes the first of `samples` (one channel, as of to_mono) and says how many: at least one, if
  // all features that there are were fetched before.
  [[nodiscard]] std::size_t take(std::span<const float> samples) {
    return resampler_.take(samples);
  }

  // The features of the next step; false if it needs further samples.
  [[nodiscard]] bool fetch(std::span<float, kFeatures> features);

  // Of what time, since the stream's first sample, step k speaks.
  [[nodiscard]] static double seconds_of_step(std::int64_t step) {
    return (static_cast<double>(step) - 1.5) * kWindowSamples / kSampleRate;
  }

 private:
  [[nodiscard]] float without_offset(float sample);

  Resampler resampler_;
  Mfcc mfcc_;
  float sample_before_ = 0.0f;
  float filtered_before_ = 0.0f;
  std::size_t known_ = 0;  // samples in window_
  std::array<float, kWindowSamples> window_ = {};
  std::array<float, kCoefficients> silence_ = {};
  std::array<float, kFeatures> features_ = {};
};

}  // namespace mien::audio
