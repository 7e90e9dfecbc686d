// Numbers as exact arithmetic gives them, each with how far a kernel that computes in fp32, in
// whatever order, may be from it. Errors are followed to first order. A sum of n products errs by
// c u sum|x w|, not by c u |sum x w| (Higham, Accuracy and Stability of Numerical Algorithms,
// chapter 3), and c grows with the root of n, for roundings go both ways (Higham & Mary, A New
// Approach to Probabilistic Rounding Error Analysis, 2019).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/activation/activation.h"

namespace mien::conformance {

inline constexpr double kUnit = 0x1p-24;  // rounding unit of fp32
// c of a few operations; sum_factor: of a sum.
inline constexpr double kSumFactor = 8.0;
[[nodiscard]] inline double sum_factor(int terms) {
  return kSumFactor + 2.0 * std::sqrt(static_cast<double>(terms));
}
// Denormal numbers may be flushed to zero: what is lost with each of them at most.
inline constexpr double kFlushed = 0x1p-126;

// How a kernel multiplies and adds up.
struct Arithmetic {
  double unit;     // of rounding
  double flushed;  // what is lost at most with a number near zero
  int chunk;       // as many products are added up like this, then such sums in fp32
  // Factors of products are first rounded to integers of 16 bits, which steps make numbers.
  bool is_quantized = false;
};
inline constexpr Arithmetic kSingleArithmetic{kUnit, kFlushed, std::numeric_limits<int>::max()};
// fp16: 11 bits, denormals kept. A value of x is rounded to them, each multiply-add is, and so is
// what lies between the layers of a block. Weights are fp16 anyway. Within a chunk errors grow as
// in any sum, with the root of its length; sums of chunks are added in fp32, so that a long sum is
// no worse, by its magnitude, than a chunk. The longest that a kernel may take for one: 16 bits
// lose no more than 1/80 of a chunk's magnitude then, and the way to fp32 costs one multiply-add in
// ten.
inline constexpr Arithmetic kHalfArithmetic{0x1p-11, 0x1p-24, 64};
// Sums of integers are exact, all else is fp32; what the steps are a family's cases say.
inline constexpr Arithmetic kFixedArithmetic{kUnit, kFlushed, std::numeric_limits<int>::max(),
                                             true};
// Of a sum that becomes fp16 in the end.
[[nodiscard]] inline Arithmetic in_one_chunk(Arithmetic by) {
  by.chunk = std::numeric_limits<int>::max();
  return by;
}

struct Approx {
  double value = 0.0;
  double error = 0.0;
};

// Of floats that are copied or converted without rounding.
[[nodiscard]] inline Approx exact(double value) { return {value, 0.0}; }

// Of floats that are compared: nothing is rounded, but vector units that know no denormal numbers,
// such as ARMv7's, take them for zero.
[[nodiscard]] inline Approx compared(double value) {
  return {value, std::abs(value) < kFlushed ? kFlushed : 0.0};
}

// The result of one more operation, in fp32 if nothing else is said.
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
// `slope`: of a PReLU, for the channel.
[[nodiscard]] Approx activated(Approx x, const kernels::ActivationSpec& activation, double slope);

}  // namespace mien::conformance
