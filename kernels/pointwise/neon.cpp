#include <algorithm>

#include "kernels/common/neon_activation.h"
#include "kernels/common/product.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

constexpr std::int32_t kFewPixels = 18;  // tiles of 9 and of 3

ProductArgs product_of(const PointwiseArgs& a, const Activator& activator) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.h} * a.w * kBlock;
  ProductArgs product{};
  product.x = a.x;
  product.x_plane_elems = plane;
  product.in_blocks = blocks_of(a.in_c);
  product.pixels = a.h * a.w;
  product.weights = a.weights;
  product.bias = a.bias;
  product.out_blocks = blocks_of(a.out_c);
  product.low = vgetq_lane_f32(activator.low(), 0);
  product.high = vgetq_lane_f32(activator.high(), 0);
  product.y = a.y;
  product.y_rows = {kBlock, plane, 2 * plane, 0x7FFFFFFF, 0};
  return product;
}

std::ptrdiff_t residual_at(const PointwiseArgs& a, std::int32_t pixel) {
  const std::ptrdiff_t y = pixel / a.w + a.residual_top, x = pixel % a.w + a.residual_left;
  return (y * a.residual_w + x) * kBlock;
}

// Sums of a few pixels and one block go through the stack to a residual that may lie where they
// belong.
void finish(const PointwiseArgs& a, const float* sums, std::int32_t block, std::int32_t pixel,
            std::int32_t count) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.h} * a.w * kBlock;
  const std::ptrdiff_t residual_plane = std::ptrdiff_t{a.residual_h} * a.residual_w * kBlock;
  for (std::int32_t p = pixel; p < pixel + count; ++p, sums += kBlock) {
    Pair value = load_pair(sums);
    if (a.residual != nullptr) {
      const Pair r = load_pair(a.residual + block * residual_plane + residual_at(a, p));
      value = {vaddq_f32(value.low, r.low), vaddq_f32(value.high, r.high)};
    }
    store_pair(a.y + block * plane + std::ptrdiff_t{p} * kBlock, value);
  }
}

void activated_product(const PointwiseArgs& a, const Activator& activator, ProductArgs product) {
  constexpr std::ptrdiff_t kHalf = kFewPixels * kBlock;
  float sums[2 * kHalf];
  product.y = sums;
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
  ProductArgs product = product_of(a, activator);
  if (activator.curves() || a.residual == a.y) {
    return activated_product(a, activator, product);
  }
  if (a.residual != nullptr) {
    const std::ptrdiff_t plane = std::ptrdiff_t{a.residual_h} * a.residual_w * kBlock;
    product.residual = a.residual + residual_at(a, 0);
    product.residual_rows = {kBlock, plane, 2 * plane, a.w,
                             std::ptrdiff_t{a.residual_w - a.w} * kBlock};
  }
  multiply_panels(product);
}

}  // namespace mien::kernels::MIEN_TIER
