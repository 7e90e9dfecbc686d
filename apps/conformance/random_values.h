// Inputs that find faults, all from one seed: signed, cancelling, denormal, huge and ordinary
// numbers, and sizes around those that kernels work in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "apps/conformance/approx.h"

namespace mien::conformance {

// Sizes of cases are small ints; containers count in another type.
[[nodiscard]] inline std::size_t as_size(int count) { return static_cast<std::size_t>(count); }

// What the numbers of a case are like.
enum class Pattern : std::uint8_t {
  kMixed,       // ordinary ones, some zero, denormal or large
  kCancelling,  // large ones that all but cancel: what is left shows every rounding
  kDenormal,    // nothing else
  kHuge,        // up to 1e29, of half precision 200: overflows where a kernel multiplies too early
  kSparse,      // mostly zeros of either sign
  kOrdinary,    // as in networks: not among those that cases take in turns
};
inline constexpr int kPatternCount = 5;  // without kOrdinary
[[nodiscard]] std::string_view name(Pattern pattern);

class RandomValues {
 public:
  // The pattern is that of the case's number, so that all have their turn. For kernels that count
  // in half precision numbers are smaller: no sum of a case leaves +-65504, and what is denormal is
  // so in fp16.
  explicit RandomValues(std::uint64_t seed, int case_number = 0,
                        const Arithmetic& arithmetic = kSingleArithmetic);
  RandomValues(std::uint64_t seed, Pattern pattern);
  // The first choices, which are those of sizes, are these: a fuzzer's. Borrowed.
  void choose_first(std::span<const std::uint8_t> choices) { choices_ = choices; }

  [[nodiscard]] Pattern pattern() const { return pattern_; }
  [[nodiscard]] int case_number() const { return case_number_; }
  // What the kernel under test may use where its family allows for half precision.
  [[nodiscard]] const Arithmetic& arithmetic() const { return arithmetic_; }
  [[nodiscard]] bool is_half() const { return arithmetic_.unit > kUnit; }

  int between(int low, int high);
  bool coin() { return between(0, 1) == 1; }
  // 1..most: around a multiple of what kernels take at once, a prime, or anything.
  int size(int most);

  float value();
  std::vector<float> plain(int count);
  // Blocks of 8 channels [ceil(c/8)][pixels][8]; unused lanes zero.
  std::vector<float> map(int pixels, int channels);

  // fp16 numbers, denormals and zeros among them.
  std::vector<std::uint16_t> halves(int count);
  // Weights and biases as the weight file packs them; those of outputs that do not exist are zero.
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
