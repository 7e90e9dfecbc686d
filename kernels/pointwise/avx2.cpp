// The avx2 tier of pointwise.
#include "kernels/common/avx2.h"
#include "kernels/families.h"
#include "kernels/pointwise/product_of.h"

namespace mien::kernels::avx2 {
namespace {

constexpr std::int32_t kFewPixels = 12;

}  // namespace

void pointwise(const PointwiseArgs& a) {
  ProductArgs product = product_of(a);
  Clamp clamp;
  const bool clamps = is_clamp(a.activation, clamp);
  product.low = clamp.low;
  product.high = clamp.high;
  if (clamps) {
    return multiply_panels(product);
  }
  product_by_parts<kFewPixels>(a, product, multiply_panels, [&](const SumsOfBlock& part) {
    for (std::int32_t p = 0; p < part.pixels; ++p) {
      const Vec sums = _mm256_loadu_ps(part.sums + p * kLanes);
      Vec value = activated(sums, a.activation, part.block, a.out_c);
      if (a.residual != nullptr) {
        value = _mm256_add_ps(value, _mm256_loadu_ps(part.residual(p)));
      }
      _mm256_storeu_ps(part.y() + p * kLanes, value);
    }
  });
}

}  // namespace mien::kernels::avx2
