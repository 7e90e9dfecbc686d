#include <algorithm>

#include "kernels/common/avx512.h"
#include "kernels/common/product.h"
#include "kernels/families.h"

namespace mien::kernels::avx512 {
namespace {

constexpr std::int32_t kFewPixels = 12;

PixelRows flat_rows(std::ptrdiff_t plane) { return {kBlock, plane, 2 * plane, 0x7FFFFFFF, 0}; }

ProductArgs product_of(const PointwiseArgs& a) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.h} * a.w * kBlock;
  ProductArgs product{};
  product.x = a.x;
  product.x_plane_elems = plane;
  product.in_blocks = blocks_of(a.in_c);
  product.pixels = a.h * a.w;
  product.weights = a.weights;
  product.bias = a.bias;
  product.out_blocks = blocks_of(a.out_c);
  product.y = a.y;
  product.y_rows = flat_rows(plane);
  return product;
}

std::ptrdiff_t residual_at(const PointwiseArgs& a, std::int32_t pixel) {
  const std::ptrdiff_t y = pixel / a.w + a.residual_top, x = pixel % a.w + a.residual_left;
  return (y * a.residual_w + x) * kBlock;
}

// Sums of a few pixels and one panel go through the stack to their activation, and to a residual
// that lies where they belong.
void finish(const PointwiseArgs& a, const float* sums, std::int32_t block, std::int32_t pixel,
            std::int32_t count) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.h} * a.w * kBlock;
  const std::ptrdiff_t residual_plane = std::ptrdiff_t{a.residual_h} * a.residual_w * kBlock;
  const bool both = block + 1 < blocks_of(a.out_c);
  const __mmask16 lanes = first_lanes(a.out_c - block * kBlock);
  for (std::int32_t p = pixel; p < pixel + count; ++p, sums += kPanel) {
    Vec value = activated(_mm512_loadu_ps(sums), a.activation, block * kBlock, lanes);
    if (a.residual != nullptr) {
      const float* r = a.residual + block * residual_plane + residual_at(a, p);
      value = _mm512_add_ps(value, load_blocks(r, residual_plane, both));
    }
    store_blocks(a.y + block * plane + std::ptrdiff_t{p} * kBlock, plane, both, value);
  }
}

void activated_product(const PointwiseArgs& a, ProductArgs product) {
  float sums[kFewPixels * kPanel] = {};
  product.y = sums;
  product.y_rows = {kPanel, kBlock, 0, 0x7FFFFFFF, 0};
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
      finish(a, sums, block, pixel, product.pixels);
    }
  }
}

}  // namespace

void pointwise(const PointwiseArgs& a) {
  ProductArgs product = product_of(a);
  Clamp clamp;
  const bool clamps = is_clamp(a.activation, clamp);
  product.low = clamp.low;
  product.high = clamp.high;
  if (!clamps || a.residual == a.y) {
    return activated_product(a, product);
  }
  if (a.residual != nullptr) {
    const std::ptrdiff_t plane = std::ptrdiff_t{a.residual_h} * a.residual_w * kBlock;
    product.residual = a.residual + residual_at(a, 0);
    product.residual_rows = {kBlock, plane, 2 * plane, a.w,
                             std::ptrdiff_t{a.residual_w - a.w} * kBlock};
  }
  multiply_panels(product);
}

}  // namespace mien::kernels::avx512
