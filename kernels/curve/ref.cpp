// The reference kernel of curve.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

double curved(Curve kind, double x) {
  constexpr double kRootHalf = 0.70710678118654752, kRootTwoOverPi = 0.79788456080286536;
  switch (kind) {
    case Curve::kHardSwish:
      return x * std::min(std::max(x + 3.0, 0.0), 6.0) / 6.0;
    case Curve::kSwish:
      return x / (1.0 + std::exp(-x));
    case Curve::kGelu:
      return 0.5 * x * std::erfc(-x * kRootHalf);
    case Curve::kGeluTanh:
      return x / (1.0 + std::exp(-2.0 * kRootTwoOverPi * (x + 0.044715 * x * x * x)));
    case Curve::kErf:
      return std::erf(x);
    case Curve::kExp:
      return std::exp(std::min(std::max(x, -87.0), 88.0));
    case Curve::kSqrt:
      break;
  }
  return std::sqrt(x);
}

}  // namespace

void curve(const CurveArgs& args) {
  for (std::int32_t c = 0; c < blocks_of(args.channels) * kBlock; ++c) {
    for (std::int32_t p = 0; p < args.pixels; ++p) {
      const std::ptrdiff_t at = blocked(c, p, args.pixels);
      const double value = curved(args.kind, static_cast<double>(args.x[at]));
      args.y[at] = c < args.channels ? static_cast<float>(value) : 0.0f;
    }
  }
}

}  // namespace mien::kernels::ref
