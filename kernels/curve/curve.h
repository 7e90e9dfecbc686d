// Element-wise functions that no other kernel fuses:
//
//   hard_swish(x) = x min(max(x + 3, 0), 6) / 6        swish(x) = x / (1 + exp(-x))
//   gelu(x) = x (1 + erf(x / sqrt 2)) / 2              erf(x), exp(x), sqrt(x)
//   gelu_tanh(x) = x (1 + tanh(sqrt(2 / pi) (x + 0.044715 x^3))) / 2
//
// x, y: [ceil(c/8)][pixels][8]; y may be x. Lanes >= c become 0. The argument of exp is clamped to
// -87 .. 88.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

enum class Curve : std::uint8_t { kHardSwish, kSwish, kGelu, kGeluTanh, kErf, kExp, kSqrt };

struct CurveArgs {
  static constexpr std::string_view kFamily = "curve";
  const float* x;
  float* y;
  Curve kind;
  std::int32_t pixels, channels;
};

}  // namespace mien::kernels
