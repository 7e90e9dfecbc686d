// Rearranges the elements of x: read in `order`, outermost axis first, they are the elements of y
// by rows, columns and channels.
//
// x: [in_h, in_w, in_c], y: [out_h, out_w, out_c] with the same number of elements, in blocks of 8
// channels, not overlapping. Lanes beyond the channels of y become 0.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

enum class Axis : std::uint8_t { kRow, kColumn, kChannel };

struct RearrangeArgs {
  static constexpr std::string_view kFamily = "rearrange";
  const float* x;
  float* y;
  std::int32_t in_h, in_w, in_c;
  std::int32_t out_h, out_w, out_c;
  Axis order[3];
};

}  // namespace mien::kernels
