// Affine warp of a camera image straight to the float crop a network reads.
//
// Output sample (i, j) covers a parallelogram of the image; it is the mean of taps x taps bilinear
// samples at
//   (x, y) = matrix [j + (u + 0.5) / taps; i + (v + 0.5) / taps; 1],   u, v = 0 .. taps-1,
// in image coordinates where pixel (column c, row r) has its centre at (c + 0.5, r + 0.5). Outside
// the image the border pixels repeat. A coordinate that is not finite counts as 0. y:
// [height][width][3] RGB, interleaved: value * scale + offset, value in 0..255.
//
// YUV is BT.601; chroma is sampled bilinearly on its own grid, sited in the middle of its 2x2
// pixels. Only bytes of pixels are read: no row is assumed to be followed by padding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace mien::kernels {

enum class PixelFormat : std::uint8_t {
  kGray8,
  kRgb,
  kBgr,
  kRgba,
  kBgra,
  kYuv420,  // Y, U and V each with its own stride; NV12, NV21 and I420 are cases of it
};

struct Plane {
  const std::uint8_t* data;
  std::ptrdiff_t row_bytes;    // may be negative
  std::ptrdiff_t pixel_bytes;  // from one sample to the next
};

struct WarpArgs {
  static constexpr std::string_view kFamily = "warp";
  PixelFormat format;
  Plane plane[3];                          // kYuv420: Y, U, V; else only the first
  bool full_range;                         // kGray8, kYuv420: luma 0..255; else 16..235
  std::int32_t image_width, image_height;  // 1..16384
  float matrix[6];                         // x = m0 j + m1 i + m2, y = m3 j + m4 i + m5
  std::int32_t taps;                       // 1..8
  float* y;
  std::int32_t width, height;
  float scale, offset;
};

}  // namespace mien::kernels
