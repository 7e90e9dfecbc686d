// Concatenates the channels of a and b at every pixel.
//
// a: [pixels, a_channels], b: [pixels, b_channels], y: [pixels, a_channels + b_channels], in blocks
// of 8 channels; y overlaps neither. Lanes beyond the channels of a and b must be 0; those of y
// become 0.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct ConcatArgs {
  static constexpr std::string_view kFamily = "concat";
  const float* a;
  const float* b;
  float* y;
  std::int32_t pixels;
  std::int32_t a_channels;
  std::int32_t b_channels;
};

}  // namespace mien::kernels
