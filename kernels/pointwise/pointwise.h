// Pointwise (1x1) convolution with a fused activation and an optional residual.
//
//   y[p, o] = act(bias[o] + sum over i of w[o, i] x[p, i]) + r[slice of p, o]
//
// x: [h, w, in_c], y: [h, w, out_c], in blocks of 8 channels; lanes >= out_c become 0. r:
// [residual_h, residual_w, out_c], whose slice at (residual_top, residual_left) is added.
// Neither x nor r may overlap y. Weights: fp16 panels of 16 output channels, [panel][i][16] with i
// up to ceil(in_c/8) * 8; the last panel is 8 wide if ceil(out_c/8) is odd.
#pragma once

#include <cstdint>
#include <string_view>

#include "kernels/activation/activation.h"

namespace mien::kernels {

struct PointwiseArgs {
  static constexpr std::string_view kFamily = "pointwise";
  const float* x;
  const std::uint16_t* weights;
  const std::uint16_t* bias;  // fp16 [ceil(out_c/8) * 8]
  float* y;
  ActivationSpec activation;
  std::int32_t h, w;
  std::int32_t in_c, out_c;
  const float* residual;  // nullptr: none
  std::int32_t residual_h, residual_w;
  std::int32_t residual_top, residual_left;
};

}  // namespace mien::kernels
