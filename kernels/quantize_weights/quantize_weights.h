// Quantizes the weights of a pointwise layer to 16 bits, with one scale per output:
//
//   w[o, i] = scales[o] q[o, i], to within half a scale
//
// Each scale is the smallest for which q fits 16 bits and the sum over i of q[o, i] v[i] fits 32
// bits for all integers v from 0 to `max_value`, or from -max_value to max_value if `is_signed`:
//
//   scales[o] = max(max over i of |w[o, i]| / 32767,
//                   max_value s[o] / (2^31 (1 - 2^-10) - max_value n / 2))
//
// where s is the sum of all magnitudes if `is_signed`, else the larger of the sums of the positive
// and of the negative weights. n = 8 in_blocks weights have a rounding error of half a scale each,
// and the factor 1 - 2^-10 allows for the rounding of s.
//
// `weights` are panels as in pointwise.h. `pairs` are panels of as many outputs, in which inputs
// that are multiplied together are adjacent:
//   of 16 outputs: [reduction/2][16][2]
//   the last, if out_blocks is odd: [reduction/4][8][2][2]
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

// Longer sums need larger scales: with this many inputs an average weight has five bits left, and
// with 131072 no scale would be large enough.
inline constexpr std::int32_t kQuantizedWeightsMaxInputs = 2048;

struct QuantizeWeightsArgs {
  static constexpr std::string_view kFamily = "quantize_weights";
  const std::uint16_t* weights;        // fp16
  std::int16_t* pairs;                 // [out_blocks * 8 * in_blocks * 8]
  float* scales;                       // [out_blocks * 8]
  std::int32_t in_blocks, out_blocks;  // of 8 channels; at most kQuantizedWeightsMaxInputs inputs
  std::int32_t max_value;              // 1..32767
  bool is_signed;
};

}  // namespace mien::kernels
