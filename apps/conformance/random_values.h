// Random test inputs from a seed: signed, cancelling, denormal, huge and ordinary values, and sizes
// around those that kernels process at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "apps/conformance/approx.h"

namespace mien::conformance {

// Converts the int sizes of cases for containers.
[[nodiscard]] inline std::size_t as_size(int count) { return static_cast<std::size_t>(count); }

// The kind of values of a case.
enum class Pattern : std::uint8_t {
  kMixed,       // ordinary, some zero, denormal or large
  kCancelling,  // large values that nearly cancel, so that every rounding shows
  kDenormal,    // only denormal
  kHuge,        // up to 1e29, 200 in half precision: detects premature overflow
  kSparse,      // mostly zeros of either sign
  kOrdinary,    // as in networks; not used by random cases
};
inline constexpr int kPatternCount = 5;  // without kOrdinary
[[nodiscard]] std::string_view name(Pattern pattern);

class RandomValues {
 public:
  // The case number selects the pattern in turn. For half-precision kernels values are smaller: no
  // sum of a case exceeds +-65504, and denormal values are denormal in fp16.
  explicit RandomValues(std::uint64_t seed, int case_number = 0,
                        const Arithmetic& arithmetic = kSingleArithmetic);
  RandomValues(std::uint64_t seed, Pattern pattern);
  // Replaces the first choices, which are sizes, for fuzzing. Not copied.
  void choose_first(std::span<const std::uint8_t> choices) { choices_ = choices; }

  [[nodiscard]] Pattern pattern() const { return pattern_; }
  [[nodiscard]] int case_number() const { return case_number_; }
  // Arithmetic of the kernel under test in families that allow half precision.
  [[nodiscard]] const Arithmetic& arithmetic() const { return arithmetic_; }
  [[nodiscard]] bool is_half() const { return arithmetic_.unit > kUnit; }

  int between(int low, int high);
  bool coin() { return between(0, 1) == 1; }
  // 1..max: near a multiple of a kernel's block size, a prime, or anything.
  int size(int max);

  float value();
  std::vector<float> plain(int count);
  // Blocks of 8 channels [ceil(c/8)][pixels][8]; unused lanes zero.
  std::vector<float> map(int pixels, int channels);

  // fp16 values, including denormals and zeros.
  std::vector<std::uint16_t> halves(int count);
  // Weights and biases in packed order; those of outputs that do not exist are zero.
  std::vector<std::uint16_t> panels(int outputs, int reduction);
  std::vector<std::uint16_t> bias(int outputs);

 private:
  float weight();
  float cancelling();

  std::mt19937_64 random_;
  std::span<const std::uint8_t> choices_;
  int case_number_;
  Pattern pattern_;
  Arithmetic arithmetic_ = kSingleArithmetic;
};

}  // namespace mien::conformance
