// A map in another size. Output row i of out_h (columns likewise) shows where in the input, of in_h
// rows:
//
//   half pixel      (i + 1/2) in_h / out_h - 1/2
//   asymmetric      i in_h / out_h
//   align corners   i (in_h - 1) / (out_h - 1), 0 where out_h is 1
//
// It is the nearest row, that place rounded as `sampling` says, or between two rows in proportion
// to their distances, along both axes (bilinear); no row beyond the first and last. Places are
// exact fractions.
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
