// The colour transform of the warp of tiers with SIMD.
#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/image/warp.h"

namespace mien::kernels::tiles {

constexpr std::int32_t kOne = 1 << 14;  // weight 1.0; its product with a sum of a box fits 32 bits

namespace {

// The transform from sums of boxes to the output: rows for red, green and blue, whose last column
// is added. The result is clamped to low..high.
struct ColourTransform {
  float weights[3][4];  // sums are scaled by kOne
  float low, high;
};

inline ColourTransform colour_transform(const WarpArgs& a) {
  const auto scale = [](std::int32_t box) {
    return 1.0f / (static_cast<float>(box * box) * static_cast<float>(kOne));
  };
  const bool has_luma = a.format == PixelFormat::kGray8 || a.format == PixelFormat::kYuv420;
  const bool limited_range = has_luma && !a.full_range;
  const float contrast = limited_range ? 255.0f / 219.0f : 1.0f;
  const float black = limited_range ? -16.0f * contrast : 0.0f;
  const float of_first = contrast * scale(a.box);
  const float colour = (limited_range ? 255.0f / 224.0f : 1.0f);
  const auto number = [](double value) { return static_cast<float>(value); };
  const YuvMatrix& m = a.yuv_matrix;
  const float of_u[3] = {0.0f, number(m.green_of_u), number(m.blue_of_u)};
  const float of_v[3] = {number(m.red_of_v), number(m.green_of_v), 0.0f};
  ColourTransform transform{};
  for (std::int32_t c = 0; c < 3; ++c) {
    float* w = transform.weights[c];
    w[3] = black;
    if (a.format == PixelFormat::kYuv420) {
      w[0] = of_first;
      w[1] = of_u[c] * colour * scale(a.chroma_box);
      w[2] = of_v[c] * colour * scale(a.chroma_box);
      w[3] -= 128.0f * colour * (of_u[c] + of_v[c]);
    } else {
      w[has_luma ? 0 : c] = of_first;
    }
    for (std::int32_t k = 0; k < 4; ++k) {
      w[k] *= a.scale;
    }
    w[3] += a.offset;
  }
  const float ends[2] = {a.offset, 255.0f * a.scale + a.offset};
  transform.low = std::min(ends[0], ends[1]);
  transform.high = std::max(ends[0], ends[1]);
  return transform;
}
}  // namespace
}  // namespace mien::kernels::tiles
