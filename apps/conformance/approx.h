// Exact values with bounds on the error of a kernel that computes in fp32, in any order. Errors are
// propagated to first order. A sum of n products has an error of c u sum|x w|, not c u |sum x w|
// (Higham, Accuracy and Stability of Numerical Algorithms, chapter 3), and c grows with the root of
// n, because rounding errors partly cancel (Higham & Mary, A New Approach to Probabilistic Rounding
// Error Analysis, 2019).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/activation/activation.h"

namespace mien::conformance {

inline constexpr double kUnit = 0x1p-24;  // unit roundoff of fp32
// c for a few operations, and for a sum of `terms` terms.
inline constexpr double kSumFactor = 8.0;
[[nodiscard]] inline double sum_factor(int terms) {
  return kSumFactor + 2.0 * std::sqrt(static_cast<double>(terms));
}
// Denormal numbers may be flushed to zero: the maximum error per flushed number.
inline constexpr double kFlushed = 0x1p-126;

// How a kernel multiplies and accumulates.
struct Arithmetic {
  double unit;     // unit roundoff
  double flushed;  // maximum error of a number near zero
  int chunk;       // number of products per partial sum; partial sums are added in fp32
  // Factors of products are first quantized to 16-bit integers, or to 8 bits if the case says so.
  bool is_quantized = false, has_int8 = false;
  int int8_panel = 16;  // outputs of a panel of weights of 8 bits
};
inline constexpr Arithmetic kSingleArithmetic{kUnit, kFlushed, std::numeric_limits<int>::max()};
// fp16: 11 bits, denormals kept. Values of x, multiply-adds and the maps between the layers of a
// block are rounded to fp16; weights are fp16 already. Within a chunk, errors grow with the root of
// its length. Chunks are added in fp32, so the relative error of a long sum is no worse. 64 is the
// maximum chunk of a kernel: its error is at most 1/80 of its magnitude, and the conversion to fp32
// costs one operation per ten multiply-adds.
inline constexpr Arithmetic kHalfArithmetic{0x1p-11, 0x1p-24, 64};
// Integer sums are exact, everything else is fp32. The cases of a family compute the scales.
inline constexpr Arithmetic kQuantizedArithmetic{kUnit, kFlushed, std::numeric_limits<int>::max(),
                                                 true};
inline constexpr Arithmetic kInt8Arithmetic{kUnit, kFlushed, std::numeric_limits<int>::max(), true,
                                            true};
inline constexpr Arithmetic kHalfOrInt8Arithmetic{0x1p-11, 0x1p-24, 64, false, true};
inline constexpr Arithmetic kHalfOrInt8MatrixArithmetic{0x1p-11, 0x1p-24, 64, false, true, 8};
// For sums that become fp16 in the end.
[[nodiscard]] inline Arithmetic in_one_chunk(Arithmetic by) {
  by.chunk = std::numeric_limits<int>::max();
  return by;
}

struct Approx {
  double value = 0.0;
  double error = 0.0;
};

// For floats that are copied or converted without rounding.
[[nodiscard]] inline Approx exact(double value) { return {value, 0.0}; }

// For floats that are only compared: they are not rounded, but vector units without denormal
// numbers, such as ARMv7's, replace these by zero.
[[nodiscard]] inline Approx compared(double value) {
  return {value, std::abs(value) < kFlushed ? kFlushed : 0.0};
}

// The result of one more operation, by default in fp32.
[[nodiscard]] inline Approx rounded(Approx x, const Arithmetic& by = kSingleArithmetic) {
  return {x.value, x.error + by.unit * std::abs(x.value) + by.flushed};
}

[[nodiscard]] inline Approx operator+(Approx a, Approx b) {
  return rounded({a.value + b.value, a.error + b.error});
}

[[nodiscard]] inline Approx operator*(Approx a, Approx b) {
  return rounded({a.value * b.value,
                  std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error});
}

// A sum of products of floats.
class Sum {
 public:
  explicit Sum(const Arithmetic& by = kSingleArithmetic) : by_(by) {}
  void add(double x, double w = 1.0) {
    value_ += x * w;
    magnitude_ += std::abs(x * w);
    flushed_ += by_.flushed * std::fmax(1.0, std::abs(w));
    ++terms_;
  }
  [[nodiscard]] Approx total() const {
    const double factor = sum_factor(std::min(terms_, by_.chunk));
    return rounded({value_, factor * by_.unit * magnitude_ + flushed_}, by_);
  }

 private:
  Arithmetic by_;
  double value_ = 0.0, magnitude_ = 0.0, flushed_ = 0.0;
  int terms_ = 0;
};

[[nodiscard]] Approx sigmoid(Approx x);
[[nodiscard]] Approx tanh(Approx x);
// `slope`: the PReLU slope of the channel.
[[nodiscard]] Approx activated(Approx x, const kernels::ActivationSpec& activation, double slope);

}  // namespace mien::conformance
