// Where whole windows lie inside the map: tiles of up to 16 output pixels of a row x one panel or
// 12 x two panels, the last of a row overlapping the previous one. Border pixels one at a time.
#include <algorithm>
#include <utility>

#include "kernels/common/avx512.h"
#include "kernels/families.h"

namespace mien::kernels::avx512 {
namespace {

struct Range {
  std::int32_t first, last;
};

Range inside(std::int32_t origin, std::int32_t kernel, std::int32_t size) {
  return {std::max(0, -origin), std::min(kernel, size - origin)};
}

// Output columns [first, last) whose whole window lies inside the map.
Range whole_windows(const Conv2dArgs& a) {
  const std::int32_t first = std::min(a.out_w, (a.pad_left + a.stride_w - 1) / a.stride_w);
  const std::int32_t last_start = a.in_w + a.pad_left - a.kernel_w;
  return {first, last_start < 0 ? first : std::clamp(last_start / a.stride_w + 1, first, a.out_w)};
}

// Output channels from `block` on, in blocks of 8: four (two panels), two or one.
struct Panels {
  const Conv2dArgs& a;
  const std::uint16_t* weights;
  std::int32_t block, blocks;
  Clamp clamp;
  bool clamps;
};

struct Windows {
  std::int32_t oy, ox;
  Range ys, xs;  // kernel rows and columns inside the map
};

template <int kPixels, int kVecs>
using Sums = Vec[kPixels][kVecs];

// kWidth is 8 for a single last block.
template <int kWidth>
Vec weights_at(const std::uint16_t* w) {
  return kWidth == kPanel ? load_half(w) : load_half(w, 0xFF);
}

// Adds `count` consecutive floats of x for pixels kStep floats apart, or `step` apart if kStep is
// 0.
template <int kPixels, int kVecs, int kStep, int kWidth>
inline const std::uint16_t* add_run(const float* x, std::int32_t count, std::ptrdiff_t step,
                                    const std::uint16_t* w, std::ptrdiff_t panel,
                                    Sums<kPixels, kVecs>& sum) {
  const std::ptrdiff_t pitch = kStep == 0 ? step : kStep;
  for (std::int32_t k = 0; k < count; ++k, w += kWidth) {
    Vec weight[kVecs];
    for (int v = 0; v < kVecs; ++v) {
      weight[v] = weights_at<kWidth>(w + v * panel);
    }
#pragma GCC unroll 16
    for (int p = 0; p < kPixels; ++p) {
      const Vec value = _mm512_set1_ps(x[p * pitch + k]);
      for (int v = 0; v < kVecs; ++v) {
        sum[p][v] = _mm512_fmadd_ps(value, weight[v], sum[p][v]);
      }
    }
  }
  return w;
}

template <int kPixels, int kVecs, int kStep, int kWidth = kPanel>
void tile(const Panels& t, const Windows& at) {
  const Conv2dArgs& a = t.a;
  const std::ptrdiff_t panel = std::ptrdiff_t{a.kernel_h} * a.kernel_w * a.in_c * kPanel;
  Sums<kPixels, kVecs> sum;
  for (int v = 0; v < kVecs; ++v) {
    const Vec bias = weights_at<kWidth>(a.bias + t.block * kBlock + v * kPanel);
#pragma GCC unroll 16
    for (int p = 0; p < kPixels; ++p) {
      sum[p][v] = bias;
    }
  }
  const std::ptrdiff_t step = std::ptrdiff_t{a.stride_w} * a.x_pixel_elems;
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kBlock;
  const std::int32_t top = at.oy * a.stride_h - a.pad_top, left = at.ox * a.stride_w - a.pad_left;
  const std::ptrdiff_t row = std::ptrdiff_t{a.in_w} * a.x_pixel_elems;
  const float* x =
      a.x + (top + at.ys.first) * row + std::ptrdiff_t{left + at.xs.first} * a.x_pixel_elems;
  const std::uint16_t* w =
      t.weights + std::ptrdiff_t{at.ys.first * a.kernel_w + at.xs.first} * a.in_c * kWidth;
  const std::ptrdiff_t w_row = std::ptrdiff_t{a.kernel_w} * a.in_c * kWidth;
  std::int32_t rows = at.ys.last - at.ys.first;
  if (a.x_pixel_elems == a.in_c) {
    // In interleaved maps, adjacent columns are contiguous in memory and in the weights.
    const std::int32_t count = (at.xs.last - at.xs.first) * a.in_c;
    for (; rows > 0; --rows, x += row, w += w_row) {
      add_run<kPixels, kVecs, kStep, kWidth>(x, count, step, w, panel, sum);
    }
  } else {
    for (; rows > 0; --rows, x += row, w += w_row) {
      const std::uint16_t* w_next = w;
      for (std::int32_t kx = at.xs.first; kx < at.xs.last; ++kx) {
        const float* x_next = x + (kx - at.xs.first) * a.x_pixel_elems;
        for (std::int32_t c = 0; c < a.in_c; c += kBlock, x_next += plane) {
          w_next = add_run<kPixels, kVecs, kStep, kWidth>(x_next, std::min(kBlock, a.in_c - c),
                                                          step, w_next, panel, sum);
        }
      }
    }
  }
  const std::ptrdiff_t out_plane = std::ptrdiff_t{a.out_h} * a.out_w * kBlock;
  float* y = a.y + t.block * out_plane + (std::ptrdiff_t{at.oy} * a.out_w + at.ox) * kBlock;
  const Vec low = _mm512_set1_ps(t.clamp.low), high = _mm512_set1_ps(t.clamp.high);
#pragma GCC unroll 16
  for (int p = 0; p < kPixels; ++p) {
    for (int v = 0; v < kVecs; ++v) {
      store_blocks(y + 2 * v * out_plane + p * kBlock, out_plane, kWidth == kPanel,
                   _mm512_min_ps(high, _mm512_max_ps(low, sum[p][v])));
    }
  }
}

// Applies activations other than clamps to the `count` pixels that a tile has stored.
void finish(const Panels& t, const Windows& at, std::int32_t count) {
  const Conv2dArgs& a = t.a;
  const std::ptrdiff_t plane = std::ptrdiff_t{a.out_h} * a.out_w * kBlock;
  for (std::int32_t block = t.block; block < t.block + t.blocks; block += 2) {
    const bool both = t.blocks > 1;
    const __mmask16 lanes = first_lanes(a.out_c - block * kBlock);
    float* y = a.y + block * plane + (std::ptrdiff_t{at.oy} * a.out_w + at.ox) * kBlock;
    for (std::int32_t p = 0; p < count; ++p, y += kBlock) {
      const Vec sum = load_blocks(y, plane, both);
      store_blocks(y, plane, both, activated(sum, a.activation, block * kBlock, lanes));
    }
  }
}

using Tile = void (*)(const Panels&, const Windows&);

struct SizedTile {
  std::int32_t pixels;
  Tile run;
};

template <int kVecs, int kStep, int... kPixels>
SizedTile smallest_of(std::int32_t pixels, std::int32_t min_pixels,
                      std::integer_sequence<int, kPixels...>) {
  SizedTile best{1, &tile<1, kVecs, kStep>};
  const auto consider = [&](SizedTile one) {
    best = one.pixels <= pixels && best.pixels < min_pixels ? one : best;
  };
  (consider({kPixels, &tile<kPixels, kVecs, kStep>}), ...);
  return best;
}

using UpTo12 = std::integer_sequence<int, 4, 12>;
using UpTo16 = std::integer_sequence<int, 4, 8, 14, 16>;

// Chooses the smallest tile that covers a row of `pixels` with as few tiles as the largest.
template <int kStep>
SizedTile tile_for(bool two_panels, std::int32_t pixels) {
  const std::int32_t max_pixels = two_panels ? 12 : 16;
  const std::int32_t tiles = (pixels + max_pixels - 1) / max_pixels;
  const std::int32_t min_pixels = (pixels + tiles - 1) / tiles;
  return two_panels ? smallest_of<2, kStep>(pixels, min_pixels, UpTo12())
                    : smallest_of<1, kStep>(pixels, min_pixels, UpTo16());
}

// Compile-time steps for mien's own networks: interleaved images of 3 channels, and blocks.
SizedTile tile_for(const Conv2dArgs& a, std::int32_t blocks, std::int32_t pixels) {
  const bool two_panels = blocks > 2;
  if (blocks == 1) {
    return pixels < 4 ? SizedTile{1, &tile<1, 1, 0, kBlock>} : SizedTile{4, &tile<4, 1, 0, kBlock>};
  }
  switch (a.stride_w * a.x_pixel_elems) {
    case 3:
      return tile_for<3>(two_panels, pixels);
    case 6:
      return tile_for<6>(two_panels, pixels);
    case 8:
      return tile_for<8>(two_panels, pixels);
    default: {
      using One = std::integer_sequence<int, 4>;
      return two_panels ? smallest_of<2, 0>(pixels, 4, One()) : smallest_of<1, 0>(pixels, 4, One());
    }
  }
}

void row(const Panels& t, std::int32_t oy, Range whole, SizedTile inner) {
  const Conv2dArgs& a = t.a;
  const Tile edge = t.blocks > 2    ? &tile<1, 2, 0>
                    : t.blocks == 2 ? &tile<1, 1, 0>
                                    : &tile<1, 1, 0, kBlock>;
  Windows at{oy, 0, inside(oy * a.stride_h - a.pad_top, a.kernel_h, a.in_h), {}};
  const auto run = [&](SizedTile one, std::int32_t ox, Range xs) {
    at.ox = ox;
    at.xs = xs;
    one.run(t, at);
    if (!t.clamps) {
      finish(t, at, one.pixels);
    }
  };
  const auto run_edge = [&](std::int32_t ox) {
    run({1, edge}, ox, inside(ox * a.stride_w - a.pad_left, a.kernel_w, a.in_w));
  };
  for (std::int32_t ox = 0; ox < whole.first; ++ox) {
    run_edge(ox);
  }
  for (std::int32_t ox = whole.first; ox < whole.last; ox += inner.pixels) {
    run(inner, std::min(ox, whole.last - inner.pixels), {0, a.kernel_w});
  }
  for (std::int32_t ox = whole.last; ox < a.out_w; ++ox) {
    run_edge(ox);
  }
}

}  // namespace

void conv2d(const Conv2dArgs& a) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{a.kernel_h} * a.kernel_w * a.in_c;
  const std::int32_t blocks = blocks_of(a.out_c);
  const Range whole = whole_windows(a);
  Panels t{a, a.weights, 0, 0, {}, false};
  t.clamps = is_clamp(a.activation, t.clamp);
  for (; t.block < blocks; t.block += t.blocks) {
    t.blocks = blocks - t.block >= 4 ? 4 : blocks - t.block >= 2 ? 2 : 1;
    t.weights = a.weights + t.block * kBlock * reduction;
    const SizedTile inner = tile_for(a, t.blocks, std::max(1, whole.last - whole.first));
    for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
      row(t, oy, whole, inner);
    }
  }
}

}  // namespace mien::kernels::avx512
