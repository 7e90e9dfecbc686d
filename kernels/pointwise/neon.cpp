#include <algorithm>

#include "kernels/common/neon_activation.h"
#include "kernels/families.h"
#include "kernels/pointwise/product_of.h"

namespace mien::kernels::MIEN_TIER {
namespace {

constexpr std::int32_t kFewPixels = 18;  // tiles of 9 and of 3

// Sums of a few pixels and one block go through the stack to a residual that may lie where they
// belong.
void finish(const PointwiseArgs& a, const float* sums, std::int32_t block, std::int32_t pixel,
            std::int32_t count) {
  const std::ptrdiff_t plane = plane_of(a), residual_plane = residual_plane_of(a);
  for (std::int32_t p = pixel; p < pixel + count; ++p, sums += kBlock) {
    Pair value = load_pair(sums);
    if (a.residual != nullptr) {
      const Pair r = load_pair(residual_at(a, p) + block * residual_plane);
      value = {vaddq_f32(value.low, r.low), vaddq_f32(value.high, r.high)};
    }
    store_pair(a.y + block * plane + std::ptrdiff_t{p} * kBlock, value);
  }
}

void activated_product(const PointwiseArgs& a, const Activator& activator, ProductArgs product) {
  constexpr std::ptrdiff_t kHalf = kFewPixels * kBlock;
  float sums[2 * kHalf];
  product.y = sums;
  product.residual = nullptr;
  product.y_rows = {kBlock, kHalf, 0, 0x7FFFFFFF, 0};
  const std::int32_t blocks = product.out_blocks;
  const std::ptrdiff_t reduction = std::ptrdiff_t{product.in_blocks} * kBlock;
  for (std::int32_t block = 0; block < blocks; block += 2) {
    product.out_blocks = std::min(2, blocks - block);
    product.weights = a.weights + block * kBlock * reduction;
    product.bias = a.bias + std::ptrdiff_t{block} * kBlock;
    for (std::int32_t pixel = 0; pixel < a.h * a.w; pixel += kFewPixels) {
      product.x = a.x + std::ptrdiff_t{pixel} * kBlock;
      product.pixels = std::min(kFewPixels, a.h * a.w - pixel);
      multiply_panels(product);
      for (std::int32_t half = 0; half < product.out_blocks; ++half) {
        float* block_sums = sums + half * kHalf;
        activator.curve_block(block_sums, product.pixels, block + half);
        finish(a, block_sums, block + half, pixel, product.pixels);
      }
    }
  }
}

}  // namespace

void pointwise(const PointwiseArgs& a) {
  const Activator activator(a.activation, a.out_c);
  ProductArgs product = product_of(a);
  product.low = vgetq_lane_f32(activator.low(), 0);
  product.high = vgetq_lane_f32(activator.high(), 0);
  if (activator.curves() || a.residual == a.y) {
    return activated_product(a, activator, product);
  }
  multiply_panels(product);
}

}  // namespace mien::kernels::MIEN_TIER
