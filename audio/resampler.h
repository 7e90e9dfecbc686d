// Any rate from 8 to 192 kHz -> 16 kHz, by a windowed sinc in polyphase form (Crochiere, Rabiner
// 1983, ch. 4; window: Kaiser 1974).
//
// The filter has 32 zero crossings of the lower of both rates on either side. Of that rate's half
// it passes 0.8 flat, and from 1.0 on it stops by 80 dB and more. Between the phases of the table,
// the answers of both neighbours are mixed linearly. Where an output lies among the inputs is
// counted in whole numbers: nothing drifts, however long it runs.
//
// Output m belongs to the time m / 16000 s after the first input. It can be had when the input has
// got `delay_seconds` further.
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
  static constexpr std::int32_t kLowestRate = 8000;
  static constexpr std::int32_t kHighestRate = 192000;

  // False when no tier of `cpu_mask` runs here.
  [[nodiscard]] bool init(std::uint32_t cpu_mask);

  // Begins a stream; `input_rate` in kLowestRate..kHighestRate. Makes the filter when the rate is
  // another one than before, which takes about a millisecond.
  void start(std::int32_t input_rate);

  // Takes the first samples of `input` and says how many: at least one, if all outputs that there
  // are were fetched before.
  [[nodiscard]] std::size_t take(std::span<const float> input);

  // The next output; false if it needs further input.
  [[nodiscard]] bool fetch(float& output);

  [[nodiscard]] std::int32_t input_rate() const { return rate_; }
  [[nodiscard]] double delay_seconds() const { return static_cast<double>(half_) / rate_; }

 private:
  static constexpr std::int32_t kOutputRate = 16000;
  static constexpr std::int32_t kZeroCrossings = 32;
  static constexpr std::int32_t kPhases = 256;  // when the input is not the faster one
  static constexpr std::int32_t kMaxSteps = kHighestRate / kOutputRate;
  static constexpr std::size_t kMaxTaps = std::size_t{2} * kZeroCrossings * kMaxSteps;
  static constexpr std::size_t kTableSize = std::size_t{2} * kZeroCrossings * (kPhases + kMaxSteps);

  void make_filter();
  void advance();
  void drop_used();

  kernels::Kernel<kernels::MatrixVectorArgs> matrix_vector_ = nullptr;
  std::int32_t rate_ = 0;
  std::int32_t half_ = 0;    // taps on either side of an output
  std::int32_t phases_ = 0;  // between two inputs
  std::int64_t whole_ = 0;   // first input of the next output's filter, in history_
  std::int32_t part_ = 0;    // how far the output is beyond an input, in 1 / kOutputRate
  std::size_t known_ = 0;    // inputs in history_
  std::array<float, 4 * kMaxTaps> history_ = {};
  std::array<float, kTableSize> filter_ = {};  // [phases + 1, 2 half]
};

}  // namespace mien::audio
