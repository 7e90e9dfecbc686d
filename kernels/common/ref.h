// Helpers shared by the reference kernels: weights, activations and addressing, in double
// precision.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/activation/activation.h"

namespace mien::kernels::ref {

inline constexpr std::int32_t kBlock = 8;   // channels of a block of a map
inline constexpr std::int32_t kPanel = 16;  // output channels of a panel of weights

[[nodiscard]] inline std::int32_t blocks_of(std::int32_t channels) { return (channels + 7) / 8; }

// Converts IEEE 754 binary16: sign, 5 bits of exponent, 10 bits of fraction.
[[nodiscard]] inline float half_to_float(std::uint16_t half) {
  const std::uint32_t sign = (half & 0x8000u) << 16;
  const std::uint32_t exponent = (half >> 10) & 0x1Fu;
  const std::uint32_t fraction = half & 0x3FFu;
  if (exponent == 0) {  // zero or denormal: fraction * 2^-24
    const float magnitude = static_cast<float>(fraction) * 0x1p-24f;
    return sign != 0 ? -magnitude : magnitude;
  }
  const std::uint32_t widened = exponent == 31 ? 255u : exponent + (127 - 15);
  return std::bit_cast<float>(sign | (widened << 23) | (fraction << 13));
}

// Weight of output o and reduction index k in panels packed as [panel][reduction][16 or 8].
[[nodiscard]] inline double panel_weight(const std::uint16_t* weights, std::int32_t outputs,
                                         std::ptrdiff_t reduction, std::int32_t o,
                                         std::ptrdiff_t k) {
  const std::int32_t padded = blocks_of(outputs) * kBlock;
  const std::int32_t first = o / kPanel * kPanel;
  const std::ptrdiff_t width = std::min(kPanel, padded - first);
  return half_to_float(weights[first * reduction + k * width + (o - first)]);
}

[[nodiscard]] inline double activated(double x, const ActivationSpec& activation,
                                      std::int32_t channel) {
  switch (activation.kind) {
    case Activation::kNone:
      return x;
    case Activation::kRelu:
      return std::max(x, 0.0);
    case Activation::kRelu6:
      return std::min(std::max(x, 0.0), 6.0);
    case Activation::kLeakyRelu:
      return x > 0 ? x : x * static_cast<double>(activation.alpha);
    case Activation::kPrelu:
      return x > 0 ? x : x * static_cast<double>(half_to_float(activation.slopes[channel]));
    case Activation::kSigmoid:
      return 1.0 / (1.0 + std::exp(-x));
    case Activation::kTanh:
      return std::tanh(x);
    case Activation::kClamp01:
      return std::min(std::max(x, 0.0), 1.0);
  }
  return x;
}

// Offset in floats of channel c of a pixel in a blocked map.
[[nodiscard]] inline std::ptrdiff_t blocked(std::int32_t c, std::ptrdiff_t pixel,
                                            std::ptrdiff_t pixels) {
  return (c / kBlock * pixels + pixel) * kBlock + c % kBlock;
}

}  // namespace mien::kernels::ref
