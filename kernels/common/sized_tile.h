// Register tiles come in a few sizes. A row of pixels consists of tiles of one size and a smaller
// one at its end, which overlaps the previous tile if no size fits: computing a pixel twice costs
// less than code for every size.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::kernels {
namespace {

template <class Run>
struct SizedTile {
  std::int32_t pixels;
  Run run;
};

// `count` tiles of `each` from the first pixel on, then `last`, unless its run is nullptr, aligned
// to the last pixel.
template <class Run>
struct Tiling {
  SizedTile<Run> each;
  std::int32_t count;
  SizedTile<Run> last;
};

// Chooses the smallest tile size that needs as few tiles for `pixels` pixels as the largest.
// `sizes` ascend; the first is at max_pixels `pixels`.
template <class Run, std::size_t kCount>
Tiling<Run> tiling_of(const SizedTile<Run> (&sizes)[kCount], std::int32_t pixels) {
  const std::int32_t max_pixels = sizes[kCount - 1].pixels;
  const std::int32_t tiles = (pixels + max_pixels - 1) / max_pixels;
  const std::int32_t min_pixels = (pixels + tiles - 1) / tiles;
  const SizedTile<Run>* each = sizes;
  while (each->pixels < min_pixels && each[1].pixels <= pixels) {
    ++each;
  }
  const std::int32_t left = pixels % each->pixels;
  const SizedTile<Run>* last = sizes;
  while (last->pixels < left) {
    ++last;
  }
  return {*each, pixels / each->pixels, left > 0 ? *last : SizedTile<Run>{}};
}

}  // namespace
}  // namespace mien::kernels
