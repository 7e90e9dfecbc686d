// Panels of quantized weights times quantized pixels, for expand and project: products of integers
// of 16 or 8 bits, summed in 32 bits.
#pragma once

#include <cstdint>

#include "kernels/common/product.h"
#include "kernels/inverted_residual/inverted_residual.h"

namespace mien::kernels {

//   y[p, o] = min(max(bias[o] + sum over i of w[o, i] x[p, i], low), high) + r[p, o]
//
// where w[o, i] = scales[o] pairs[o, i] (quantize_weights.h) and x[p, i] = x_scale values[p, i].
// `to.x`, `to.weights` and `to.fp32_weights` are ignored.
//
// With 8 bits, `values` and `pairs` hold twice as many integers in as many bytes: `values` unsigned
// ones, in blocks of 16 channels, which `to.in_blocks` counts, and `pairs` the quads of
// quantize_to_int8.h. As `values` then contain x_shift in addition, x_shift sums[o] scales[o]
// x_scale is subtracted.
struct QuantizedProduct {
  ProductArgs to;
  const std::int16_t* values;  // [in_blocks] blocks of 8 channels of [pixels]
  std::ptrdiff_t plane_elems;
  float x_scale;
  const std::int16_t* pairs;
  const float* scales;
  const float* sums;  // nullptr with 16 bits
  float x_shift;
  [[nodiscard]] bool is_int8() const { return sums != nullptr; }
};

// Integers of 16 bits per pixel of a block, of any number of bits.
inline constexpr std::ptrdiff_t kQuantizedPixel = 8;

using MultiplyQuantized = void (*)(const QuantizedProduct& product);

namespace avx2int16 {
void multiply_quantized(const QuantizedProduct& product);
// Runs a block, whose expand and project layers call `multiply`.
void quantized_block(const InvertedResidualArgs& args, MultiplyQuantized multiply);
}  // namespace avx2int16
namespace avxvnni {
void multiply_quantized(const QuantizedProduct& product);
}  // namespace avxvnni
namespace avx512vnni {
void multiply_quantized(const QuantizedProduct& product);
}  // namespace avx512vnni
namespace wasmint16 {
void multiply_quantized(const QuantizedProduct& product);
void multiply_floats(const ProductArgs& product);
}  // namespace wasmint16

}  // namespace mien::kernels
