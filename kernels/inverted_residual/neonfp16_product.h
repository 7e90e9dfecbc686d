// Panels of weights times pixels in half precision: what a fused block expands and projects with.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::kernels::neonfp16 {

//   y[p, o] = min(max(bias[o] + sum over i of w[o, i] x[p, i], low), high)
struct HalfProduct {
  const std::uint16_t* x;  // panels of 16 channels of [pixels][16]
  std::ptrdiff_t x_panel_elems;
  std::int32_t in_blocks;  // of 8 channels
  std::int32_t pixels;
  const std::uint16_t* weights;  // panels of 16 outputs, as of pointwise.h
  const std::uint16_t* bias;     // [out_blocks * 8]
  std::int32_t out_blocks;
  float low, high;
};

// Where the pixels of a strip lie: [panel of 16][row][column][16].
struct StripRows {
  std::uint16_t* y;
  std::ptrdiff_t panel_elems, row_elems;
  std::int32_t row_pixels;
};

// Where the pixels of a map lie: blocks of 8 of [pixel][8]; and what is added to them, row by row.
struct MapRows {
  float* y;
  std::ptrdiff_t plane_elems;
  const float* residual;  // nullptr: none
  std::ptrdiff_t residual_plane_elems, residual_row_elems;
  std::int32_t row_pixels;
};

// All sums in half precision: rounding grows with the root of in_blocks.
void multiply_to_strip(const HalfProduct& product, const StripRows& to);
// Sums of up to kHalfSum products in half precision, which are added up in fp32.
constexpr std::int32_t kHalfSum = 64;
void multiply_to_map(const HalfProduct& product, const MapRows& to);

}  // namespace mien::kernels::neonfp16
