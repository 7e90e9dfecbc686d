// Panels of weights times pixels, the core of pointwise layers and fused blocks. One function per
// tier, because each has many register tiles.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::kernels {

constexpr std::ptrdiff_t kChannels = 8;  // channels of a block of a map

// Layout of pixels in rows.
struct PixelRows {
  std::ptrdiff_t pixel_elems;  // from one pixel to the next
  std::ptrdiff_t half_elems;   // from the lower 8 channels of a panel to the upper 8
  std::ptrdiff_t panel_elems;  // from one panel to the next
  std::int32_t row_pixels;
  std::ptrdiff_t row_gap_elems;  // skipped after each row
};

//   y[p, o] = min(max(bias[o] + sum over i of w[o, i] x[p, i], low), high) + r[p, o]
//
// r does not overlap y.
struct ProductArgs {
  const float* x;  // [in_blocks] blocks of 8 channels of [pixels]
  std::ptrdiff_t x_plane_elems;
  std::int32_t in_blocks;
  std::int32_t pixels;
  const std::uint16_t* weights;  // fp16 panels, as of pointwise.h
  const std::uint16_t* bias;     // fp16 [out_blocks * 8]
  std::int32_t out_blocks;
  float low, high;
  float* y;
  PixelRows y_rows;
  const float* residual;  // nullptr: none
  PixelRows residual_rows;
  float* fp32_weights;  // [kFp32WeightElems] for weights in fp32 when there are many pixels;
                        // nullptr: none
};
inline constexpr std::int32_t kFp32WeightElems = 6144;

namespace avx2 {
void multiply_panels(const ProductArgs& args);
}
namespace avx512 {
void multiply_panels(const ProductArgs& args);
}
namespace neon {
void multiply_panels(const ProductArgs& args);
}
namespace neon32 {
void multiply_panels(const ProductArgs& args);
}

}  // namespace mien::kernels
