// Affine warp of a camera image straight to the float crop a network reads.
//
// The image is first made smaller by a power of two, `box`: a sample of it is the mean of box x box
// pixels, counted from the image's corner. An output sample (i, j) is the bilinear sample of that
// at
//   (x, y) = matrix [j + 0.5; i + 0.5; 1]
// in coordinates of the full image, where pixel (column c, row r) has its centre at (c + 0.5,
// r + 0.5), and a small sample its own in the middle of its pixels. (That is a mipmap of one level:
// Williams, Pyramidal parametrics, 1983.) Outside the image the border pixels repeat. A coordinate
// that is not finite counts as 0. y: [height][width][3] RGB, interleaved: value * scale + offset,
// value in 0..255. Between two neighbours in a row a tier may round its place to 1/16384 of their
// distance.
//
// Chroma, sited in the middle of its 2x2 pixels, has its own grid and its own box.
// Only bytes from a row's first pixel to its last are read: no row is assumed to be followed by
// padding.
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

// What a sample of chroma, less its middle, adds to red, green and blue.
struct YuvMatrix {
  double red_of_v, green_of_u, green_of_v, blue_of_u;
};
inline constexpr YuvMatrix kBt601 = {1.402, -0.344136, -0.714136, 1.772};
inline constexpr YuvMatrix kBt709 = {1.5748, -0.187324, -0.468124, 1.8556};

struct WarpArgs {
  static constexpr std::string_view kFamily = "warp";
  PixelFormat format;
  Plane plane[3];                          // kYuv420: Y, U, V; else only the first
  bool full_range;                         // kGray8, kYuv420: luma 0..255; else 16..235
  YuvMatrix yuv_matrix;                    // of kYuv420
  std::int32_t image_width, image_height;  // 1..16384
  float matrix[6];                         // x = m0 j + m1 i + m2, y = m3 j + m4 i + m5
  std::int32_t box;                        // 1, 2, 4 or 8
  std::int32_t chroma_box;                 // the same of chroma samples, where there are any
  float* y;
  std::int32_t width, height;
  float scale, offset;
  std::uint16_t* samples;  // [kWarpSampleElems], for the tiers to work in
};

inline constexpr std::int32_t kWarpSampleElems = 19456;

}  // namespace mien::kernels
