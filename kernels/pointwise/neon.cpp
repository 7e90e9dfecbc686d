// The neon and neon32 tiers of pointwise.
#include "kernels/common/neon_activation.h"
#include "kernels/families.h"
#include "kernels/pointwise/product_of.h"

namespace mien::kernels::MIEN_TIER {
namespace {

constexpr std::int32_t kFewPixels = 18;  // tiles of 9 and of 3

}  // namespace

void pointwise(const PointwiseArgs& a) {
  const Activator activator(a.activation, a.out_c);
  ProductArgs product = product_of(a);
  product.low = vgetq_lane_f32(activator.low(), 0);
  product.high = vgetq_lane_f32(activator.high(), 0);
  if (!activator.curves()) {
    return multiply_panels(product);
  }
  product_by_parts<kFewPixels>(a, product, multiply_panels, [&](const SumsOfBlock& part) {
    activator.curve_block(part.sums, part.pixels, part.block);
    for (std::int32_t p = 0; p < part.pixels; ++p) {
      Pair value = load_pair(part.sums + p * kBlock);
      if (a.residual != nullptr) {
        const Pair r = load_pair(part.residual(p));
        value = {vaddq_f32(value.low, r.low), vaddq_f32(value.high, r.high)};
      }
      store_pair(part.y() + p * kBlock, value);
    }
  });
}

}  // namespace mien::kernels::MIEN_TIER
