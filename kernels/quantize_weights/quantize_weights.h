// Weights of a pointwise layer in fixed point, 16 bits each, with a step of its own for each
// output:
//
//   w[o, i] = steps[o] q[o, i], but for half a step
//
// Steps are as small as they may be for q to go into 16 bits, and a sum over i of q[o, i] v[i] into
// 32, whatever integers v are: from 0 to `most`, or from -most to most if `is_signed`.
//
//   steps[o] = max(max over i of |w[o, i]| / 32767, most s[o] / (2^31 (1 - 2^-10) - most n / 2))
//
// where s is the sum of all magnitudes if `is_signed`, else the larger of that of the positive and
// that of the negative weights; the n = 8 in_blocks weights are each off by half a step, and 2^-10
// is left to the rounding of s.
//
// `weights` are panels as of pointwise.h; `pairs` are panels of as many outputs, in which elements
// of the sum that are multiplied together lie together:
//   of 16 outputs: [reduction/2][16][2]
//   the last, if out_blocks is odd: [reduction/4][8][2][2]
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

// The longer the sum, the wider the steps: with this many inputs a weight of average size has five
// bits left, and with 131072 no step would be wide enough.
inline constexpr std::int32_t kQuantizedWeightsMaxInputs = 2048;

struct QuantizeWeightsArgs {
  static constexpr std::string_view kFamily = "quantize_weights";
  const std::uint16_t* weights;  // fp16
  std::int16_t* pairs;           // [out_blocks * 8 * in_blocks * 8]
  float* scales;                 // [out_blocks * 8]
  std::int32_t in_blocks,
      out_blocks;     // of 8 channels; at most kQuantizedWeightsMaxInputs of them in
  std::int32_t most;  // up to 32767
  bool is_signed;
};

}  // namespace mien::kernels
