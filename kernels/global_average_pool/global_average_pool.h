// Mean over all pixels: y[c] = sum over p of x[p, c] / pixels, per channel.
//
// x: [pixels, c] in blocks of 8 channels, y: [c]; not overlapping. Lanes >= c of x must be 0; those
// of y become 0. The error does not grow with the map: it is at most that of some hundred pixels in
// fp32.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct GlobalAveragePoolArgs {
  static constexpr std::string_view kFamily = "global_average_pool";
  const float* x;
  float* y;
  std::int32_t pixels;
  std::int32_t channels;
};

}  // namespace mien::kernels
