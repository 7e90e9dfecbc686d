// Mean of a whole map: y[c] = sum over all pixels of x[p, c] / pixels, per channel.
//
// x: [pixels, c] in blocks of 8 channels, y: [c]; not overlapping. Lanes >= c of x are zero, and so
// are those of y. However large the map, the mean errs by no more than that of some hundred pixels
// in fp32.
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
