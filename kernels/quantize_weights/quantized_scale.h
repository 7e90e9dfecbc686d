// How large the steps of weights in fixed point have to be.
#pragma once

#include "kernels/quantize_weights/quantize_weights.h"

namespace mien::kernels {
namespace {

// Times the largest magnitude among the weights: they go into 16 bits.
inline constexpr float kScaleOfLargest = 1.0f / 32767.0f;

// Times what values can make of the weights.
inline float scale_of_reach(const QuantizeWeightsArgs& a) {
  const double most = a.most, rounding = 0.5 * 8.0 * a.in_blocks * most;
  return static_cast<float>(most / (0x1p31 * (1.0 - 0x1p-10) - rounding));
}

}  // namespace
}  // namespace mien::kernels
