// Depthwise convolution: one small filter per channel and a fused activation.
//
//   y[oy, ox, c] = act(bias[c] + sum over ky, kx of w[c, ky, kx] x[oy s + ky - pad, ox s + kx -
//   pad, c])
//
// where x is zero outside the map. x: [h, w, c] and y: [out_h, out_w, c] in blocks of 8 channels,
// not overlapping. Weights: fp16 [ceil(c/8)][ky][kx][8]. Lanes >= c of x must be 0; those of y
// become 0.
#pragma once

#include <cstdint>
#include <string_view>

#include "kernels/activation/activation.h"

namespace mien::kernels {

struct DepthwiseArgs {
  static constexpr std::string_view kFamily = "depthwise";
  const float* x;
  const std::uint16_t* weights;
  const std::uint16_t* bias;  // fp16 [ceil(c/8) * 8]
  float* y;
  ActivationSpec activation;
  std::int32_t channels;
  std::int32_t in_h, in_w;
  std::int32_t out_h, out_w;
  std::int32_t kernel_h, kernel_w;
  std::int32_t stride_h, stride_w;
  std::int32_t pad_top, pad_left;
};

}  // namespace mien::kernels
