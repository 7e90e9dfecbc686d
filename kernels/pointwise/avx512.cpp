// The avx512 tier of pointwise.
#include <algorithm>

#include "kernels/common/avx512.h"
#include "kernels/families.h"
#include "kernels/pointwise/product_of.h"

namespace mien::kernels::avx512 {
namespace {

constexpr std::int32_t kFewPixels = 12;

// Applies the activation and then the residual to sums of a few pixels and one panel, which are on
// the stack.
void finish(const PointwiseArgs& a, const float* sums, std::int32_t block, std::int32_t pixel,
            std::int32_t count) {
  const std::ptrdiff_t plane = plane_of(a), residual_plane = residual_plane_of(a);
  const bool both = block + 1 < blocks_of(a.out_c);
  const __mmask16 lanes = first_lanes(a.out_c - block * kBlock);
  for (std::int32_t p = pixel; p < pixel + count; ++p, sums += kPanel) {
    Vec value = activated(_mm512_loadu_ps(sums), a.activation, block * kBlock, lanes);
    if (a.residual != nullptr) {
      const float* r = residual_at(a, p) + block * residual_plane;
      value = _mm512_add_ps(value, load_blocks(r, residual_plane, both));
    }
    store_blocks(a.y + block * plane + std::ptrdiff_t{p} * kBlock, plane, both, value);
  }
}

void activated_product(const PointwiseArgs& a, ProductArgs product) {
  float sums[kFewPixels * kPanel] = {};
  product.y = sums;
  product.residual = nullptr;
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
  if (!clamps) {
    return activated_product(a, product);
  }
  multiply_panels(product);
}

}  // namespace mien::kernels::avx512
