// Panels of 8-bit weights times 8-bit pixels, for expand and project in neondot and neoni8mm.
#pragma once

#include "kernels/inverted_residual/half_product.h"

namespace mien::kernels::MIEN_TIER {

//   y[p, o] = min(max(bias[o] + sum over i of w[o, i] x[p, i], low), high)
//
// where w[o, i] = scales[o] quads[o, i] (quantize_to_int8.h) and x[p, i] = x_scale values[p, i],
// for project x_scale (values[p, i] + kInt8Shift). `to.x` and `to.weights` are ignored.
struct DotProduct {
  HalfProduct to;
  const std::int8_t* values;  // planes of [pixels][channels], see dot_strips.h
  std::ptrdiff_t plane_elems;
  float x_scale;
  const std::int8_t* quads;
  const float *scales, *sums;
};

void multiply_to_strip(const DotProduct& product, const StripRows& to);
void multiply_to_map(const DotProduct& product, const MapRows& to);

}  // namespace mien::kernels::MIEN_TIER
