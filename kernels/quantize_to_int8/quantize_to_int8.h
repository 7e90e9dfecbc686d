// Quantizes the weights of a pointwise layer to 8 bits, with one scale per output:
//
//   scales[o] = max over i of |w[o, i]| / 127
//   w[o, i] = scales[o] q[o, i], to within half a scale
//   sums[o] = sum over i of q[o, i]
//
// `weights` are panels as in pointwise.h. `quads` are panels of `panel` outputs, in which inputs
// that are multiplied together are adjacent. The reduction is padded with zeros to a multiple of
// 16:
//   of 16 outputs: [reduction/4][16][4]
//   of 8 outputs, and the last of 16 if out_blocks is odd: [reduction/8][8][2][4]
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct QuantizeToInt8Args {
  static constexpr std::string_view kFamily = "quantize_to_int8";
  const std::uint16_t* weights;        // fp16
  std::int8_t* quads;                  // [out_blocks * 8 * in_blocks rounded up to even * 8]
  float* scales;                       // [out_blocks * 8]
  float* sums;                         // [out_blocks * 8]
  std::int32_t in_blocks, out_blocks;  // of 8 channels; at most kQuantizedWeightsMaxInputs inputs
  std::int32_t panel;                  // 8 in neoni8mm, 16 in the other tiers, both in ref
};

// Greatest magnitude of q.
inline constexpr std::int32_t kInt8WeightMax = 127;

}  // namespace mien::kernels
