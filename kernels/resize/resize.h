// Resizes a map. Row i of out_h output rows (columns likewise) samples the in_h input rows at the
// position
//
//   half pixel      (i + 1/2) in_h / out_h - 1/2
//   asymmetric      i in_h / out_h
//   align corners   i (in_h - 1) / (out_h - 1), 0 where out_h is 1
//
// The sample is the nearest row, with the position rounded by `sampling`, or the linear
// interpolation of two rows along both axes (bilinear). Positions are clamped to the first and last
// row and computed as exact fractions.
//
// x: [in_h, in_w, c], y: [out_h, out_w, c], in blocks of 8 channels, not overlapping.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

enum class Grid : std::uint8_t { kHalfPixel, kAsymmetric, kAlignCorners };
enum class Sampling : std::uint8_t { kRoundHalfDown, kRoundHalfUp, kFloor, kCeil, kBilinear };

struct ResizeArgs {
  static constexpr std::string_view kFamily = "resize";
  const float* x;
  float* y;
  std::int32_t in_h, in_w, out_h, out_w, channels;
  Grid grid;
  Sampling sampling;
};

}  // namespace mien::kernels
