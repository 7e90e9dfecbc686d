// The reference kernel of combine.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

double combined(Combination kind, double a, double b) {
  switch (kind) {
    case Combination::kProduct:
      return a * b;
    case Combination::kQuotient:
      return a / b;
    case Combination::kSum:
      break;
  }
  return a + b;
}

}  // namespace

void combine(const CombineArgs& args) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{args.h} * args.w;
  const std::int32_t b_h = args.repeats_rows ? 1 : args.h, b_w = args.repeats_columns ? 1 : args.w;
  for (std::int32_t c = 0; c < blocks_of(args.channels) * kBlock; ++c) {
    for (std::ptrdiff_t p = 0; p < pixels; ++p) {
      const std::ptrdiff_t row = args.repeats_rows ? 0 : p / args.w;
      const std::ptrdiff_t column = args.repeats_columns ? 0 : p % args.w;
      const std::ptrdiff_t at = blocked(c, p, pixels);
      const std::ptrdiff_t from =
          blocked(args.repeats_channels ? 0 : c, row * b_w + column, std::ptrdiff_t{b_h} * b_w);
      const double value =
          combined(args.kind, static_cast<double>(args.a[at]), static_cast<double>(args.b[from]));
      args.y[at] = c < args.channels ? static_cast<float>(value) : 0.0f;
    }
  }
}

}  // namespace mien::kernels::ref
