// Numbers as exact arithmetic gives them, each with how far a kernel that computes in fp32, in
// whatever order, may be from it. Errors are followed to first order. A sum of n products errs by
// c u sum|x w|, not by c u |sum x w| (Higham, Accuracy and Stability of Numerical Algorithms,
// chapter 3), and c grows with the root of n, for roundings go both ways (Higham & Mary, A New
// Approach to Probabilistic Rounding Error Analysis, 2019).
#pragma once

#include <cmath>

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

struct Approx {
  double value = 0.0;
  double error = 0.0;
};

// Of floats that are copied, compared or converted without rounding.
[[nodiscard]] inline Approx exact(double value) { return {value, 0.0}; }

// The result of one more operation in fp32.
[[nodiscard]] inline Approx rounded(Approx x) {
  return {x.value, x.error + kUnit * std::abs(x.value) + kFlushed};
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
  void add(double x, double w = 1.0) {
    value_ += x * w;
    magnitude_ += std::abs(x * w);
    flushed_ += kFlushed * std::fmax(1.0, std::abs(w));
    ++terms_;
  }
  [[nodiscard]] Approx total() const {
    return rounded({value_, sum_factor(terms_) * kUnit * magnitude_ + flushed_});
  }

 private:
  double value_ = 0.0, magnitude_ = 0.0, flushed_ = 0.0;
  int terms_ = 0;
};

[[nodiscard]] Approx sigmoid(Approx x);
[[nodiscard]] Approx tanh(Approx x);
// `slope`: of a PReLU, for the channel.
[[nodiscard]] Approx activated(Approx x, const kernels::ActivationSpec& activation, double slope);

}  // namespace mien::conformance
