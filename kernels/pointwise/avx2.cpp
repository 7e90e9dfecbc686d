#include <algorithm>

#include "kernels/common/avx2.h"
#include "kernels/families.h"
#include "kernels/pointwise/product_of.h"

namespace mien::kernels::avx2 {
namespace {

constexpr std::int32_t kFewPixels = 12;

// Sums of a few pixels and one panel go through the stack to their activation, and to a residual
// that lies where they belong.
void finish(const PointwiseArgs& a, const float* sums, std::int32_t block, std::int32_t pixel,
            std::int32_t count) {
  const std::ptrdiff_t plane = plane_of(a), residual_plane = residual_plane_of(a);
  for (std::int32_t p = pixel; p < pixel + count; ++p, sums += kLanes) {
    Vec value = activated(_mm256_loadu_ps(sums), a.activation, block, a.out_c);
    if (a.residual != nullptr) {
      const float* r = residual_at(a, p) + block * residual_plane;
      value = _mm256_add_ps(value, _mm256_loadu_ps(r));
    }
    _mm256_storeu_ps(a.y + block * plane + std::ptrdiff_t{p} * kLanes, value);
  }
}

void activated_product(const PointwiseArgs& a, ProductArgs product) {
  float sums[2 * kFewPixels * kLanes] = {};
  constexpr std::ptrdiff_t kHalf = kFewPixels * kLanes;
  product.y = sums;
  product.residual = nullptr;
  product.y_rows = {kLanes, kHalf, 0, 0x7FFFFFFF, 0};
  const std::int32_t blocks = product.out_blocks;
  const std::ptrdiff_t reduction = std::ptrdiff_t{product.in_blocks} * kLanes;
  for (std::int32_t block = 0; block < blocks; block += 2) {
    product.out_blocks = std::min(2, blocks - block);
    product.weights = a.weights + block * kLanes * reduction;
    product.bias = a.bias + std::ptrdiff_t{block} * kLanes;
    for (std::int32_t pixel = 0; pixel < a.h * a.w; pixel += kFewPixels) {
      product.x = a.x + std::ptrdiff_t{pixel} * kLanes;
      product.pixels = std::min(kFewPixels, a.h * a.w - pixel);
      multiply_panels(product);
      for (std::int32_t half = 0; half < product.out_blocks; ++half) {
        finish(a, sums + half * kHalf, block + half, pixel, product.pixels);
      }
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
  multiply_panels(product);
}

}  // namespace mien::kernels::avx2
