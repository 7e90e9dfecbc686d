// Register tiles come in a few sizes. A row of pixels is made of tiles of one size and, at its end,
// a smaller one, which overlaps the one before if none fits: making a pixel twice costs less than
// code for every size.
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

// `count` tiles `each` from the first pixel on, then `last`, unless its run is nullptr, for those
// pixels that end with the last.
template <class Run>
struct Tiling {
  SizedTile<Run> each;
  std::int32_t count;
  SizedTile<Run> last;
};

// As few tiles for `pixels` pixels as the largest would do, of the smallest size. `sizes`: upwards;
// the first is at most `pixels`.
template <class Run, std::size_t kCount>
Tiling<Run> tiling_of(const SizedTile<Run> (&sizes)[kCount], std::int32_t pixels) {
  const std::int32_t most = sizes[kCount - 1].pixels;
  const std::int32_t tiles = (pixels + most - 1) / most;
  const std::int32_t wanted = (pixels + tiles - 1) / tiles;
  const SizedTile<Run>* each = sizes;
  while (each->pixels < wanted && each[1].pixels <= pixels) {
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
