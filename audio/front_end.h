// Converts audio of any rate to the input of AudioNet: the MFCCs of five windows, every 16 ms.
//
// Resampler -> high-pass at 20 Hz, against the constant offset of microphones -> MFCC -> the last
// five windows, oldest first. Windows before the first one are silence. Step k describes the middle
// of its windows, (256 k - 384) / 16000 s after the stream's first sample. It is available 40 ms
// later, plus the 2 ms of the resampler.
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

  // False if no tier of `cpu_mask` can run on this CPU.
  [[nodiscard]] bool init(std::uint32_t cpu_mask);

  // Starts a stream of `input_rate` Hz (see Resampler).
  void start(std::int32_t input_rate);

  // Takes samples from the front of `samples` (mono, as from to_mono) and returns their number: at
  // least one if all available features have been fetched.
  [[nodiscard]] std::size_t take(std::span<const float> samples) {
    return resampler_.take(samples);
  }

  // The features of the next step; false if it needs more samples.
  [[nodiscard]] bool fetch(std::span<float, kFeatures> features);

  // The log-mel energies of the newest window of the features fetched last.
  [[nodiscard]] std::span<const float, kBands> log_mel() const { return mfcc_.log_mel(); }

  // The time that a step describes, in seconds after the stream's first sample.
  [[nodiscard]] static double seconds_of_step(std::int64_t step) {
    return (static_cast<double>(step) - 1.5) * kWindowSamples / kSampleRate;
  }

 private:
  [[nodiscard]] float high_pass(float sample);

  Resampler resampler_;
  Mfcc mfcc_;
  float previous_sample_ = 0.0f;
  float previous_filtered_ = 0.0f;
  std::size_t window_size_ = 0;  // samples in window_
  std::array<float, kWindowSamples> window_ = {};
  std::array<float, kCoefficients> silence_ = {};
  std::array<float, kFeatures> features_ = {};
};

}  // namespace mien::audio
