// Expresses a pointwise layer as a product of panels of weights and pixels.
#pragma once

#include <algorithm>

#include "kernels/common/product.h"
#include "kernels/pointwise/pointwise.h"

namespace mien::kernels {
namespace {

inline std::ptrdiff_t plane_of(const PointwiseArgs& a) {
  return std::ptrdiff_t{a.h} * a.w * kChannels;
}
inline std::ptrdiff_t residual_plane_of(const PointwiseArgs& a) {
  return std::ptrdiff_t{a.residual_h} * a.residual_w * kChannels;
}

// Address of the residual for a pixel of the first block.
inline const float* residual_at(const PointwiseArgs& a, std::int32_t pixel) {
  const std::ptrdiff_t y = pixel / a.w + a.residual_top, x = pixel % a.w + a.residual_left;
  return a.residual + (y * a.residual_w + x) * kChannels;
}

inline ProductArgs product_of(const PointwiseArgs& a) {
  const std::ptrdiff_t plane = plane_of(a), residual_plane = residual_plane_of(a);
  ProductArgs product{};
  product.x = a.x;
  product.x_plane_elems = plane;
  product.in_blocks = (a.in_c + 7) / 8;
  product.pixels = a.h * a.w;
  product.weights = a.weights;
  product.bias = a.bias;
  product.out_blocks = (a.out_c + 7) / 8;
  product.y = a.y;
  product.y_rows = {kChannels, plane, 2 * plane, 0x7FFFFFFF, 0};
  if (a.residual != nullptr) {
    product.residual = residual_at(a, 0);
    product.residual_rows = {kChannels, residual_plane, 2 * residual_plane, a.w,
                             (a.residual_w - a.w) * kChannels};
  }
  return product;
}

// Sums of a few pixels and one block of 8 channels, on the stack.
struct SumsOfBlock {
  const PointwiseArgs& a;
  float* sums;  // [pixels][8]
  std::int32_t block, first, pixels;

  // Address of their output.
  [[nodiscard]] float* y() const { return a.y + block * plane_of(a) + first * kChannels; }
  // Address of the residual for pixel `p` of these.
  [[nodiscard]] const float* residual(std::int32_t p) const {
    return residual_at(a, first + p) + block * residual_plane_of(a);
  }
};

// A product with an activation other than a clamp. Its sums go through the stack, and `finish` is
// called with each SumsOfBlock.
template <std::int32_t kMaxPixels, class Multiply, class Finish>
void product_by_parts(const PointwiseArgs& a, ProductArgs product, Multiply multiply,
                      Finish finish) {
  constexpr std::ptrdiff_t kHalf = kMaxPixels * kChannels;
  float sums[2 * kHalf] = {};
  product.y = sums;
  product.residual = nullptr;
  product.y_rows = {kChannels, kHalf, 0, 0x7FFFFFFF, 0};
  const std::int32_t blocks = product.out_blocks, pixels = product.pixels;
  const std::ptrdiff_t reduction = product.in_blocks * kChannels;
  for (std::int32_t block = 0; block < blocks; block += 2) {
    product.out_blocks = std::min(2, blocks - block);
    product.weights = a.weights + block * kChannels * reduction;
    product.bias = a.bias + block * kChannels;
    for (std::int32_t first = 0; first < pixels; first += kMaxPixels) {
      product.x = a.x + first * kChannels;
      product.pixels = std::min(kMaxPixels, pixels - first);
      multiply(product);
      for (std::int32_t half = 0; half < product.out_blocks; ++half) {
        finish(SumsOfBlock{a, sums + half * kHalf, block + half, first, product.pixels});
      }
    }
  }
}

}  // namespace
}  // namespace mien::kernels
