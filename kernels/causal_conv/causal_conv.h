// One step of a causal convolution over time with kernel 2: y_t = act(W [x_{t-1}; x_t] + b).
//
// x: [in_elems], a multiple of 8. previous: [in_elems], x of the previous step, initially zeros;
// replaced by x. y: [ceil(out_c/8) * 8], elements >= out_c become 0. None of them may overlap.
// Weights: fp16 panels of 16 outputs, [panel][2 in_elems][16], those of `previous` first; the last
// panel is 8 wide if ceil(out_c/8) is odd.
#pragma once

#include <cstdint>
#include <string_view>

#include "kernels/activation/activation.h"

namespace mien::kernels {

struct CausalConvArgs {
  static constexpr std::string_view kFamily = "causal_conv";
  const float* x;
  float* previous;
  const std::uint16_t* weights;
  const std::uint16_t* bias;  // fp16 [ceil(out_c/8) * 8]
  float* y;
  ActivationSpec activation;
  std::int32_t in_elems;
  std::int32_t out_c;
};

}  // namespace mien::kernels
