// Error bounds of activations.
#include "apps/conformance/approx.h"

#include <algorithm>

namespace mien::conformance {
namespace {

using kernels::Activation;

// Errors of a kernel's own exponential functions, in units of rounding: an exponential of 2 ulp, a
// sum and a quotient; for |x| >= 0.2, 1 - 2 / (exp(2x) + 1) cancels to no less than a fifth.
constexpr double kSigmoidUnits = 8.0;
constexpr double kTanhUnits = 20.0;

// For a monotonic function: evaluates both ends of the interval of x.
template <class Function>
Approx monotonic(Function f, Approx x) {
  const double y = f(x.value);
  return {y, std::max(f(x.value + x.error) - y, y - f(x.value - x.error))};
}

Approx with_own_error(Approx y, double units) {
  return rounded({y.value, y.error + units * kUnit * std::abs(y.value) + 2 * kFlushed});
}

Approx scaled_below_zero(Approx x, double slope) {
  const double steepest = std::max(1.0, std::abs(slope));
  return rounded({x.value > 0 ? x.value : x.value * slope, steepest * x.error});
}

Approx clamped(Approx x, double low, double high) {
  return monotonic([=](double v) { return std::clamp(v, low, high); }, x);
}

}  // namespace

Approx sigmoid(Approx x) {
  const auto f = [](double v) { return 1.0 / (1.0 + std::exp(-v)); };
  return with_own_error(monotonic(f, x), kSigmoidUnits);
}

Approx tanh(Approx x) {
  const auto f = [](double v) { return std::tanh(v); };
  return with_own_error(monotonic(f, x), kTanhUnits);
}

Approx activated(Approx x, const kernels::ActivationSpec& activation, double slope) {
  switch (activation.kind) {
    case Activation::kNone:
      return x;
    case Activation::kRelu:
      return clamped(x, 0.0, HUGE_VAL);
    case Activation::kRelu6:
      return clamped(x, 0.0, 6.0);
    case Activation::kLeakyRelu:
      return scaled_below_zero(x, static_cast<double>(activation.alpha));
    case Activation::kPrelu:
      return scaled_below_zero(x, slope);
    case Activation::kSigmoid:
      return sigmoid(x);
    case Activation::kTanh:
      return tanh(x);
    case Activation::kClamp01:
      return clamped(x, 0.0, 1.0);
  }
  return x;
}

}  // namespace mien::conformance
