// Panels of weights times pixels in half precision, for expand and project in tiers with fp16
// arithmetic. A panel of pixels has as many channels as a panel of the tier's strip.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::kernels {

using Half = std::uint16_t;  // fp16 bits

//   y[p, o] = min(max(bias[o] + sum over i of w[o, i] x[p, i], low), high)
struct HalfProduct {
  const Half* x;  // panels of [pixels][channels of a panel]
  std::ptrdiff_t x_panel_elems;
  std::int32_t in_blocks;  // blocks of 8 channels
  std::int32_t pixels;
  const Half* weights;  // panels of 16 outputs, see pointwise.h
  const Half* bias;     // [out_blocks * 8]
  std::int32_t out_blocks;
  float low, high;
};

// Output pixels in a strip: [panel][row][column][channels of a panel].
struct StripRows {
  Half* y;
  std::ptrdiff_t panel_elems, row_elems;
  std::int32_t row_pixels;
};

// Output pixels in a map, in blocks [pixel][8], and the residual to add row by row.
struct MapRows {
  float* y;
  std::ptrdiff_t plane_elems;
  const float* residual;  // nullptr: none
  std::ptrdiff_t residual_plane_elems, residual_row_elems;
  std::int32_t row_pixels;
};

// multiply_to_strip sums in half precision, at most kHalfMaxExpandInputs products. multiply_to_map
// sums up to kHalfSum products in half precision and adds these sums in fp32.
inline constexpr std::int32_t kHalfSum = 64;

namespace avx512fp16 {
inline constexpr std::int32_t kHalves = 32;  // lanes of a vector: one panel
// `scratch`: [kSumsElems].
inline constexpr std::int32_t kSumsElems = 1344;
void multiply_to_strip(const HalfProduct& product, const StripRows& to);
void multiply_to_map(const HalfProduct& product, const MapRows& to, float* scratch);
}  // namespace avx512fp16
namespace neonfp16 {
void multiply_to_strip(const HalfProduct& product, const StripRows& to);
void multiply_to_map(const HalfProduct& product, const MapRows& to);
}  // namespace neonfp16

}  // namespace mien::kernels
