// IEEE 754 binary16 <-> binary32, rounding to nearest, ties to even.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct HalfToFloatArgs {
  static constexpr std::string_view kFamily = "half_to_float";
  const std::uint16_t* x;  // [n]
  float* y;                // [n]
  std::int32_t n;
};

struct FloatToHalfArgs {
  static constexpr std::string_view kFamily = "float_to_half";
  const float* x;    // [n]
  std::uint16_t* y;  // [n]
  std::int32_t n;
};

}  // namespace mien::kernels
