// Cases of curve, with the expected results.
#include <algorithm>

#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::Curve;
using kernels::CurveArgs;

// Error of a kernel's erf and exponential, in units of the factor that they multiply: near zero it
// is 1.5e-7, which is 2.5 units.
constexpr double kCurveUnits = 12.0;

double exponential(double x) { return std::exp(std::clamp(x, -87.0, 88.0)); }

Approx with_error(double y, double error) { return rounded({y, error + 2 * kFlushed}); }

// Bounds the effect of the rounding and the clamping of the argument of exp.
Approx divided_by_exponential(double x, double u) {
  const double y = x / (1.0 + std::exp(-u));
  const double units = kCurveUnits + std::min(std::abs(u), 200.0) * 4.0;
  return with_error(y, units * kUnit * std::abs(y) + std::abs(x) * std::exp(-87.0));
}

Approx curved(Curve kind, double x) {
  constexpr double kRootHalf = 0.70710678118654752, kRootTwoOverPi = 0.79788456080286536;
  switch (kind) {
    case Curve::kHardSwish:
      return with_error(x * std::clamp(x + 3.0, 0.0, 6.0) / 6.0, kCurveUnits * kUnit * std::abs(x));
    case Curve::kSwish:
      return divided_by_exponential(x, x);
    case Curve::kGelu:
      return with_error(0.5 * x * std::erfc(-x * kRootHalf), kCurveUnits * kUnit * std::abs(x));
    case Curve::kGeluTanh:
      return divided_by_exponential(x, 2.0 * kRootTwoOverPi * (x + 0.044715 * x * x * x));
    case Curve::kErf:
      return with_error(std::erf(x), kCurveUnits * kUnit * std::min(1.0, std::abs(x)));
    case Curve::kExp: {
      const double y = exponential(x);
      return with_error(y, kCurveUnits * kUnit * y);
    }
    case Curve::kSqrt:
      break;
  }
  const double y = std::sqrt(x);
  return with_error(y, 4 * kUnit * y + (x < kFlushed ? std::sqrt(kFlushed) : 0.0));
}

Case make(RandomValues& random, int pixels, int channels, Curve kind, bool in_place) {
  std::vector<float> x = random.map(pixels, channels);
  if (kind == Curve::kSqrt) {  // requires non-negative arguments
    std::transform(x.begin(), x.end(), x.begin(), [](float one) { return std::abs(one); });
  }
  const std::vector<Approx> y = expected_map(channels, pixels, [&](int c, int p) {
    return curved(kind, static_cast<double>(x[blocked(c, p, pixels)]));
  });
  Case test;
  test.shape = std::to_string(pixels) + " pixels, " + std::to_string(channels) +
               " channels, curve " + std::to_string(static_cast<int>(kind)) +
               (in_place ? ", in place" : "");
  if (in_place) {
    test.buffers = {updates(x, y)};
  } else {
    test.buffers = {writes(Element::kFloat, y), reads(x)};
  }
  test.bind = [=](const Addresses& buffers) {
    return arguments(
        CurveArgs{buffers.floats(in_place ? 0 : 1), buffers.floats(0), kind, pixels, channels});
  };
  test.call = call<CurveArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<CurveArgs>(RandomValues& random) {
  const int pixels = random.size(50), channels = random.size(33);
  const auto kind = static_cast<Curve>(random.between(0, static_cast<int>(Curve::kSqrt)));
  return make(random, pixels, channels, kind, random.coin());
}

template <>
Case typical_case<CurveArgs>(RandomValues& random) {
  return make(random, 196, 96, Curve::kGelu, false);
}

}  // namespace mien::conformance
