// The reference kernel of pointwise.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

double dot_product(const PointwiseArgs& a, std::ptrdiff_t pixel, std::int32_t o) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.h} * a.w;
  const std::ptrdiff_t reduction = std::ptrdiff_t{blocks_of(a.in_c)} * kBlock;
  double sum = 0.0;
  for (std::int32_t i = 0; i < a.in_c; ++i) {
    sum += panel_weight(a.weights, a.out_c, reduction, o, i) *
           static_cast<double>(a.x[blocked(i, pixel, pixels)]);
  }
  return sum;
}

double residual_at(const PointwiseArgs& a, std::int32_t y, std::int32_t x, std::int32_t o) {
  if (a.residual == nullptr) {
    return 0.0;
  }
  const std::ptrdiff_t pixel =
      std::ptrdiff_t{y + a.residual_top} * a.residual_w + x + a.residual_left;
  return a.residual[blocked(o, pixel, std::ptrdiff_t{a.residual_h} * a.residual_w)];
}

}  // namespace

void pointwise(const PointwiseArgs& a) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.h} * a.w;
  for (std::int32_t o = 0; o < blocks_of(a.out_c) * kBlock; ++o) {
    for (std::int32_t y = 0; y < a.h; ++y) {
      for (std::int32_t x = 0; x < a.w; ++x) {
        const std::ptrdiff_t pixel = std::ptrdiff_t{y} * a.w + x;
        const double sum = half_to_float(a.bias[o]) + dot_product(a, pixel, o);
        const double result = activated(sum, a.activation, o) + residual_at(a, y, x, o);
        a.y[blocked(o, pixel, pixels)] = o < a.out_c ? static_cast<float>(result) : 0.0f;
      }
    }
  }
}

}  // namespace mien::kernels::ref
