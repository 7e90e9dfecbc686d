// Extracts a part of a map: y[oy, ox, c] = x[top + oy, left + ox, first_channel + c].
//
// x: [in_h, in_w, at least first_channel + channels], y: [h, w, channels], in blocks of 8 channels,
// not overlapping. Lanes beyond the channels of y become zero.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct SliceArgs {
  static constexpr std::string_view kFamily = "slice";
  const float* x;
  float* y;
  std::int32_t in_h, in_w;
  std::int32_t top, left, first_channel;
  std::int32_t h, w, channels;
};

}  // namespace mien::kernels
