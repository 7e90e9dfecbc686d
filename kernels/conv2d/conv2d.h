// Two-dimensional convolution with a small kernel and a fused activation.
//
//   y[oy, ox, o] = act(bias[o] + sum over ky, kx, i of w[o, ky, kx, i] x[oy s + ky - pad, ox s + kx
//   - pad, i])
//
// where x is zero outside the map. x: [h, w, c], either in blocks of 8 channels or interleaved with
// a pixel pitch of c. y: [out_h, out_w, out_c] in blocks; lanes >= out_c become 0. x and y must not
// overlap. Weights: fp16 panels of 16 output channels, [panel][ky][kx][i][16]; the last panel is 8
// wide if ceil(out_c/8) is odd.
#pragma once

#include <cstdint>
#include <string_view>

#include "kernels/activation/activation.h"

namespace mien::kernels {

struct Conv2dArgs {
  static constexpr std::string_view kFamily = "conv2d";
  const float* x;
  const std::uint16_t* weights;
  const std::uint16_t* bias;  // fp16 [ceil(out_c/8) * 8]
  float* y;
  ActivationSpec activation;
  std::int32_t in_h, in_w, in_c;
  std::int32_t x_pixel_elems;  // 8 if in blocks, in_c if interleaved
  std::int32_t out_h, out_w, out_c;
  std::int32_t kernel_h, kernel_w;
  std::int32_t stride_h, stride_w;
  std::int32_t pad_top, pad_left;
};

}  // namespace mien::kernels
