// Fully connected layer: y = act(W x + b).
//
// x: [in_elems], a vector or a flattened map including its unused lanes; in_elems is a multiple of
// 8. y: [ceil(out_c/8) * 8], elements >= out_c become 0; must not overlap x. Weights: fp16 panels
// of 16 outputs, [panel][in_elems][16]; the last panel is 8 wide if ceil(out_c/8) is odd.
#pragma once

#include <cstdint>
#include <string_view>

#include "kernels/activation/activation.h"

namespace mien::kernels {

struct FullyConnectedArgs {
  static constexpr std::string_view kFamily = "fully_connected";
  const float* x;
  const std::uint16_t* weights;
  const std::uint16_t* bias;  // fp16 [ceil(out_c/8) * 8]
  float* y;
  ActivationSpec activation;
  std::int32_t in_elems;
  std::int32_t out_c;
};

}  // namespace mien::kernels
