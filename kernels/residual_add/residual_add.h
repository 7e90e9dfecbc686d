// y = x + the slice of r at (top, left).
//
// x, y: [h, w, c], r: [residual_h, residual_w, c], in blocks of 8 channels. y may be x, or r if
// both have the same size.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct ResidualAddArgs {
  static constexpr std::string_view kFamily = "residual_add";
  const float* x;
  const float* residual;
  float* y;
  std::int32_t channels;
  std::int32_t h, w;
  std::int32_t residual_h, residual_w;
  std::int32_t residual_top, residual_left;
};

}  // namespace mien::kernels
