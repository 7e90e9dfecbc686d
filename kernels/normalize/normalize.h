// Normalizes the channels of each pixel to mean 0, variance 1: y_c = (x_c - mean) / sqrt(variance +
// epsilon).
//
// x, y: [pixels, c] in blocks of 8 channels; y may be x. Lanes >= c become 0.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct NormalizeArgs {
  static constexpr std::string_view kFamily = "normalize";
  const float* x;
  float* y;
  float epsilon;  // > 0
  std::int32_t pixels, channels;
};

}  // namespace mien::kernels
