// Lower bounds of the scales of quantized weights (quantize_weights.h).
#pragma once

#include "kernels/quantize_weights/quantize_weights.h"

namespace mien::kernels {
namespace {

// Times the largest magnitude of the weights: keeps q within 16 bits.
inline constexpr float kScaleOfLargest = 1.0f / 32767.0f;

// Times the sum of magnitudes s: keeps sums within 32 bits.
inline float scale_of_reach(const QuantizeWeightsArgs& a) {
  const double max = a.max_value, rounding = 0.5 * 8.0 * a.in_blocks * max;
  return static_cast<float>(max / (0x1p31 * (1.0 - 0x1p-10) - rounding));
}

}  // namespace
}  // namespace mien::kernels
