// Fused inverted residual block (Sandler et al. 2018): expand (1x1), depthwise, project (1x1) and
// optionally a residual, whose slice at (residual_top, residual_left) is added to the result.
//
//   e[p, c] = act1(b1[c] + sum over i of w1[c, i] x[p, i])
//   s[q, c] = act2(b2[c] + sum over ky, kx of w2[c, ky, kx] e[window of q, c])
//   y[q, o] = act3(b3[o] + sum over c of w3[o, c] s[q, c]) + r[slice of q, o]
//
// where e is zero outside the map. Without `expand.weights`, e is x and in_c = hidden_c. Shapes and
// layouts are those of pointwise.h and depthwise.h: x [in_h, in_w, in_c], y [out_h, out_w, out_c],
// r [residual_h, residual_w, out_c]; none may overlap y. Activations: none, ReLU, ReLU6 or clamp01.
//
// e and s are never complete in memory. The kernel computes bands of `band_rows` rows of s for all
// channels, from strips of `strip_rows` rows of e for `strip_channels` channels:
//   band: [ceil(hidden_c/16)][band_rows][out_w][16]
//   strip: [strip_channels/16][strip_rows][strip_w][16]
// Half-precision tiers use the same number of bytes in an order of their own and first convert the
// input of a band's expand layer to
//   half_input: [ceil(in_c/32)][min(in_h, (band_rows - 1) stride_h + kernel_h)][in_w][16]
// strip_channels is a multiple of 16, strip_rows = kernel_h + n stride_h for some n >= 0, and
// strip_w >= pad_left + in_w and >= (out_w - 1) stride_w + kernel_w.
#pragma once

#include <cstdint>
#include <string_view>

#include "kernels/activation/activation.h"

namespace mien::kernels {

struct InvertedResidualArgs {
  static constexpr std::string_view kFamily = "inverted_residual";
  struct Weights {
    const std::uint16_t* weights;
    const std::uint16_t* bias;
    ActivationSpec activation;
    // The quantized weights (quantize_weights.h); nullptr for tiers that do not use them.
    const std::int16_t* pairs;
    const float* scales;
    // Weights of 8 bits and their sums (quantize_to_int8.h), used instead of `pairs`; nullptr
    // without them. Inputs of the layer are clamped to this bound, which is positive.
    const std::int8_t* quads;
    const float* sums;
    float input_bound;
  };
  const float* x;
  float* y;
  Weights expand, depthwise, project;
  std::int32_t in_h, in_w, in_c;
  std::int32_t hidden_c;
  std::int32_t out_h, out_w, out_c;
  std::int32_t kernel_h, kernel_w;
  std::int32_t stride_h, stride_w;
  std::int32_t pad_top, pad_left;
  const float* residual;  // nullptr: none
  std::int32_t residual_h, residual_w;
  std::int32_t residual_top, residual_left;
  float* band;
  float* strip;
  float* fp32_weights;  // [kInvertedResidualFp32WeightElems]
  float* half_input;    // nullptr for fp32 tiers and without expand.weights
  std::int32_t band_rows;
  std::int32_t strip_channels, strip_rows, strip_w;
};

inline constexpr std::int32_t kInvertedResidualFp32WeightElems = 6144;

// The longest sums that fp16 tiers accumulate in fp16: those of expand, one product per input
// channel, and of depthwise, one product per tap. A sum of n fused multiply-adds has an error of at
// most n u / (1 - n u) times the sum of its magnitudes, with u = 2^-11 (Higham, Accuracy and
// Stability of Numerical Algorithms, 2002, section 3.1): 6.7 % for 128 products, 3.2 % for 64. For
// longer sums the bound becomes useless, and a running sum of n equal terms stops growing once a
// term is below half a unit in its last place. Blocks with longer sums are computed in fp32.
inline constexpr std::int32_t kHalfMaxExpandInputs = 128, kHalfMaxTaps = 64;

// `in_c`: 0 without an expand layer.
[[nodiscard]] constexpr bool has_short_half_sums(std::int32_t in_c, std::int32_t kernel_h,
                                                 std::int32_t kernel_w) {
  return in_c <= kHalfMaxExpandInputs && kernel_h <= kHalfMaxTaps / kernel_w;
}

// Maximum magnitudes of quantized values of the signed map and of the unsigned band. The band uses
// one bit less, which leaves one more to its weights, whose sums are longer.
inline constexpr std::int32_t kQuantizedMapMax = 32767, kQuantizedBandMax = 16383;

// The same with 8 bits. Tiers that multiply unsigned values store those of the map as value +
// kInt8Shift, tiers that multiply signed values those of the band as value - kInt8Shift.
inline constexpr std::int32_t kInt8MapMax = 127, kInt8BandMax = 255, kInt8Shift = 128;

}  // namespace mien::kernels
