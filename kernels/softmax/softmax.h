// Softmax over the channels of every pixel: y_c = exp(x_c - max x) / sum exp(x - max x).
//
// x, y: [pixels, c] in blocks of 8 channels; y may be x. Lanes >= c become 0.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct SoftmaxArgs {
  static constexpr std::string_view kFamily = "softmax";
  const float* x;
  float* y;
  std::int32_t pixels;
  std::int32_t channels;
};

}  // namespace mien::kernels
