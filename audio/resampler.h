// Resamples audio of 8 to 192 kHz to 16 kHz with a polyphase windowed sinc (Crochiere, Rabiner
// 1983, ch. 4; window: Kaiser 1974).
//
// The filter is a sinc with 32 zero crossings on each side, at the lower of both rates. Relative to
// that rate's Nyquist frequency it is flat up to 0.8 and attenuates by at least 80 dB from 1.0 on.
// Outputs between two phases of the table are interpolated linearly. Positions are integers, so
// that they never drift.
//
// Output m belongs to the time m / 16000 s after the first input, and is available `delay_seconds`
// later.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/matrix_vector/matrix_vector.h"
#include "kernels/registry.h"

namespace mien::audio {

class Resampler {
 public:
  static constexpr std::int32_t kMinRate = 8000;
  static constexpr std::int32_t kMaxRate = 192000;

  // False if no tier of `cpu_mask` can run on this CPU.
  [[nodiscard]] bool init(std::uint32_t cpu_mask);

  // Starts a stream; `input_rate` in kMinRate..kMaxRate, Hz. If the rate changes, computes a
  // new filter, which takes about a millisecond.
  void start(std::int32_t input_rate);

  // Takes samples from the front of `input` and returns their number: at least one if all available
  // outputs have been fetched.
  [[nodiscard]] std::size_t take(std::span<const float> input);

  // The next output; false if it needs more input.
  [[nodiscard]] bool fetch(float& output);

  [[nodiscard]] std::int32_t input_rate() const { return rate_; }
  [[nodiscard]] double delay_seconds() const { return static_cast<double>(half_) / rate_; }

 private:
  static constexpr std::int32_t kOutputRate = 16000;
  static constexpr std::int32_t kZeroCrossings = 32;
  static constexpr std::int32_t kPhases = 256;  // if the input rate is at most the output rate
  static constexpr std::int32_t kMaxSteps = kMaxRate / kOutputRate;
  static constexpr std::size_t kMaxTaps = std::size_t{2} * kZeroCrossings * kMaxSteps;
  static constexpr std::size_t kTableSize = std::size_t{2} * kZeroCrossings * (kPhases + kMaxSteps);

  void make_filter();
  void advance();
  void drop_used();

  kernels::Kernel<kernels::MatrixVectorArgs> matrix_vector_ = nullptr;
  std::int32_t rate_ = 0;
  std::int32_t half_ = 0;    // taps on each side of an output
  std::int32_t phases_ = 0;  // phases between two inputs
  std::int64_t whole_ = 0;   // index in history_ of the next output's first input
  std::int32_t part_ = 0;    // distance of the next output from an input, in input periods / 16000
  std::size_t history_size_ = 0;  // number of inputs in history_
  std::array<float, 4 * kMaxTaps> history_ = {};
  std::array<float, kTableSize> filter_ = {};  // [phases + 1, 2 half]
};

}  // namespace mien::audio
