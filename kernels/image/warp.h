// Affine warp of a camera image to the crop that a network reads, in one pass.
//
// The image is first reduced by a power of two, `box`: a sample is the mean of box x box pixels,
// counted from the image's corner. Output (i, j) is the bilinear sample of the reduced image at
//   (x, y) = matrix [j + 0.5; i + 0.5; 1]
// in coordinates of the full image, where pixel (column c, row r) has its centre at (c + 0.5,
// r + 0.5) and a sample at the centre of its box. (This is a mipmap with one level: Williams,
// Pyramidal parametrics, 1983.) Border pixels repeat outside the image. Coordinates that are not
// finite count as 0. y: [height][width][3] RGB, interleaved: value * scale + offset with value in
// 0..255. A tier may round a position between two neighbours of a row to 1/16384 of their distance.
//
// Chroma is sited at the centre of its 2x2 pixels and has its own grid and box. Only bytes from a
// row's first pixel to its last are read: rows need no padding.
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
  kYuv420,  // Y, U and V with a stride each: NV12, NV21, I420
};

struct Plane {
  const std::uint8_t* data;
  std::ptrdiff_t row_bytes;    // may be negative
  std::ptrdiff_t pixel_bytes;  // distance between samples
};

// Factors from chroma, minus its midpoint, to red, green and blue.
struct YuvMatrix {
  double red_of_v, green_of_u, green_of_v, blue_of_u;
};
inline constexpr YuvMatrix kBt601 = {1.402, -0.344136, -0.714136, 1.772};
inline constexpr YuvMatrix kBt709 = {1.5748, -0.187324, -0.468124, 1.8556};

struct WarpArgs {
  static constexpr std::string_view kFamily = "warp";
  PixelFormat format;
  Plane plane[3];                          // kYuv420: Y, U, V; others: only the first
  bool full_range;                         // kGray8, kYuv420: luma 0..255; else 16..235
  YuvMatrix yuv_matrix;                    // kYuv420 only
  std::int32_t image_width, image_height;  // 1..16384
  float matrix[6];                         // x = m0 j + m1 i + m2, y = m3 j + m4 i + m5
  std::int32_t box;                        // 1, 2, 4 or 8
  std::int32_t chroma_box;                 // likewise for chroma samples, kYuv420 only
  float* y;
  std::int32_t width, height;
  float scale, offset;
  std::uint16_t* samples;  // [kWarpSampleElems]: scratch
};

inline constexpr std::int32_t kWarpSampleElems = 19456;

}  // namespace mien::kernels
