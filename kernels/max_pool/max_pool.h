// Maximum of each window: y[oy, ox, c] = max over the window of x, per channel.
//
// x: [h, w, c], y: [out_h, out_w, c] in blocks of 8 channels, not overlapping. Windows are clipped
// to the map; every window must contain at least one value.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct MaxPoolArgs {
  static constexpr std::string_view kFamily = "max_pool";
  const float* x;
  float* y;
  std::int32_t channels;
  std::int32_t in_h, in_w;
  std::int32_t out_h, out_w;
  std::int32_t kernel_h, kernel_w;
  std::int32_t stride_h, stride_w;
  std::int32_t pad_top, pad_left;
};

}  // namespace mien::kernels
