// Panels of weights times pixels in fixed point: 16 bits multiplied, 32 bits added up. What a fused
// block expands and projects with in tiers that have such arithmetic.
#pragma once

#include <cstdint>

#include "kernels/common/product.h"

namespace mien::kernels {

//   y[p, o] = min(max(bias[o] + sum over i of w[o, i] x[p, i], low), high) + r[p, o]
//
// where w[o, i] = steps[o] pairs[o, i], as quantize_weights.h has them, and x[p, i] = x_step
// values[p, i]. Of `to` everything counts but x, weights and wide, to a strip the residual neither.
struct QuantizedProduct {
  ProductArgs to;
  const std::int16_t* values;  // [in_blocks] blocks of 8 channels of [pixels]
  std::ptrdiff_t plane_elems;
  float x_scale;
  const std::int16_t* pairs;
  const float* scales;
};

namespace avx512vnni {
void multiply_fixed_to_strip(const QuantizedProduct& product);
void multiply_fixed_to_map(const QuantizedProduct& product);
}  // namespace avx512vnni

}  // namespace mien::kernels
