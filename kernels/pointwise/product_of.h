// A pointwise layer as a product of panels of weights and pixels.
#pragma once

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

// What is added to a pixel of the first block.
inline const float* residual_at(const PointwiseArgs& a, std::int32_t pixel) {
  const std::ptrdiff_t y = pixel / a.w + a.residual_top, x = pixel % a.w + a.residual_left;
  return a.residual + (y * a.residual_w + x) * kChannels;
}

// With a residual that does not lie where the result does.
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
  if (a.residual != nullptr && a.residual != a.y) {
    product.residual = residual_at(a, 0);
    product.residual_rows = {kChannels, residual_plane, 2 * residual_plane, a.w,
                             (a.residual_w - a.w) * kChannels};
  }
  return product;
}

}  // namespace
}  // namespace mien::kernels
