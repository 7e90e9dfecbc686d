// Panels of quantized weights times quantized pixels, for expand and project: products of 16-bit
// integers, summed in 32 bits.
#pragma once

#include <cstdint>

#include "kernels/common/product.h"
#include "kernels/inverted_residual/inverted_residual.h"

namespace mien::kernels {

//   y[p, o] = min(max(bias[o] + sum over i of w[o, i] x[p, i], low), high) + r[p, o]
//
// where w[o, i] = scales[o] pairs[o, i] (quantize_weights.h) and x[p, i] = x_scale values[p, i].
// `to.x`, `to.weights` and `to.fp32_weights` are ignored.
struct QuantizedProduct {
  ProductArgs to;
  const std::int16_t* values;  // [in_blocks] blocks of 8 channels of [pixels]
  std::ptrdiff_t plane_elems;
  float x_scale;
  const std::int16_t* pairs;
  const float* scales;
};

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

}  // namespace mien::kernels
