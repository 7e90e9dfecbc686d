// Where whole windows lie inside the map: tiles of up to 6 output pixels of a row x 16 output
// channels, the last of a row overlapping the previous one. Border pixels one at a time.
#include <algorithm>
#include <utility>

#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {
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

// Output channels from `block` on: two blocks of 8, or a single last block.
struct Panel {
  const Conv2dArgs& a;
  const std::uint16_t* weights;
  std::int32_t block;
  Clamp clamp;
  bool clamps;
};

struct Windows {
  std::int32_t oy, ox;
  Range ys, xs;  // kernel rows and columns inside the map
};

template <int kPixels, int kVecs>
using Sums = Vec[kPixels][kVecs];

// Adds `count` consecutive floats of x for pixels kStep floats apart, or `step` apart if kStep is
// 0.
template <int kPixels, int kVecs, int kStep>
inline const std::uint16_t* add_run(const float* x, std::int32_t count, std::ptrdiff_t step,
                                    const std::uint16_t* w, Sums<kPixels, kVecs>& sum) {
  const std::ptrdiff_t pitch = kStep == 0 ? step : kStep;
  for (std::int32_t k = 0; k < count; ++k, w += kVecs * kLanes) {
    Vec weight[kVecs];
    for (int v = 0; v < kVecs; ++v) {
      weight[v] = load_half(w + v * kLanes);
    }
#pragma GCC unroll 8
    for (int p = 0; p < kPixels; ++p) {
      const Vec value = _mm256_broadcast_ss(x + p * pitch + k);
      for (int v = 0; v < kVecs; ++v) {
        sum[p][v] = _mm256_fmadd_ps(value, weight[v], sum[p][v]);
      }
    }
  }
  return w;
}

template <int kPixels, int kVecs, int kStep>
void tile(const Panel& t, const Windows& at) {
  const Conv2dArgs& a = t.a;
  Sums<kPixels, kVecs> sum;
  for (int v = 0; v < kVecs; ++v) {
    const Vec bias = load_half(a.bias + (t.block + v) * kLanes);
#pragma GCC unroll 8
    for (int p = 0; p < kPixels; ++p) {
      sum[p][v] = bias;
    }
  }
  const std::ptrdiff_t step = std::ptrdiff_t{a.stride_w} * a.x_pixel_elems;
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kLanes;
  const std::int32_t top = at.oy * a.stride_h - a.pad_top, left = at.ox * a.stride_w - a.pad_left;
  // In interleaved maps, adjacent columns are contiguous in memory and in the weights.
  const bool runs_on = a.x_pixel_elems == a.in_c;
  const std::int32_t columns = runs_on ? at.xs.last - at.xs.first : 1;
  for (std::int32_t ky = at.ys.first; ky < at.ys.last; ++ky) {
    for (std::int32_t kx = at.xs.first; kx < at.xs.last; kx += columns) {
      const float* x = a.x + (std::ptrdiff_t{top + ky} * a.in_w + left + kx) * a.x_pixel_elems;
      const std::ptrdiff_t k = std::ptrdiff_t{ky * a.kernel_w + kx} * a.in_c;
      const std::uint16_t* w = t.weights + k * kVecs * kLanes;
      for (std::int32_t c = 0; c < a.in_c; c += runs_on ? a.in_c : kLanes, x += plane) {
        const std::int32_t count = runs_on ? columns * a.in_c : std::min(kLanes, a.in_c - c);
        w = add_run<kPixels, kVecs, kStep>(x, count, step, w, sum);
      }
    }
  }
  const std::ptrdiff_t out_plane = std::ptrdiff_t{a.out_h} * a.out_w * kLanes;
  float* y = a.y + t.block * out_plane + (std::ptrdiff_t{at.oy} * a.out_w + at.ox) * kLanes;
  const Vec low = _mm256_set1_ps(t.clamp.low), high = _mm256_set1_ps(t.clamp.high);
#pragma GCC unroll 8
  for (int p = 0; p < kPixels; ++p) {
    for (int v = 0; v < kVecs; ++v) {
      _mm256_storeu_ps(y + v * out_plane + p * kLanes,
                       _mm256_min_ps(high, _mm256_max_ps(low, sum[p][v])));
    }
  }
}

// Applies activations other than clamps to the `count` pixels that a tile has stored.
void finish(const Panel& t, const Windows& at, std::int32_t blocks, std::int32_t count) {
  const Conv2dArgs& a = t.a;
  const std::ptrdiff_t plane = std::ptrdiff_t{a.out_h} * a.out_w * kLanes;
  for (std::int32_t block = t.block; block < t.block + blocks; ++block) {
    float* y = a.y + block * plane + (std::ptrdiff_t{at.oy} * a.out_w + at.ox) * kLanes;
    for (std::int32_t p = 0; p < count; ++p, y += kLanes) {
      _mm256_storeu_ps(y, activated(_mm256_loadu_ps(y), a.activation, block, a.out_c));
    }
  }
}

struct SizedTile {
  std::int32_t pixels;
  void (*run)(const Panel&, const Windows&);
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

// Chooses the smallest tile that covers a row of `pixels` with as few tiles as the largest.
template <int kVecs, int kStep>
SizedTile tile_for(std::int32_t pixels) {
  constexpr std::int32_t kMax = 6;
  const std::int32_t tiles = (pixels + kMax - 1) / kMax;
  return smallest_of<kVecs, kStep>(pixels, (pixels + tiles - 1) / tiles,
                                   std::integer_sequence<int, 2, 4, kMax>());
}

// Compile-time steps for interleaved images of 3 channels and for blocks.
template <int kVecs>
SizedTile tile_for(const Conv2dArgs& a, std::int32_t pixels) {
  switch (kVecs == 2 ? a.stride_w * a.x_pixel_elems : 0) {
    case 3:
      return tile_for<2, 3>(pixels);
    case 6:
      return tile_for<2, 6>(pixels);
    case 8:
      return tile_for<2, 8>(pixels);
    default:
      return tile_for<kVecs, 0>(pixels);
  }
}

template <int kVecs>
void row(const Panel& t, std::int32_t oy, Range whole, SizedTile inner) {
  const Conv2dArgs& a = t.a;
  Windows at{oy, 0, inside(oy * a.stride_h - a.pad_top, a.kernel_h, a.in_h), {}};
  const auto run = [&](SizedTile one, std::int32_t ox, Range xs) {
    at.ox = ox;
    at.xs = xs;
    one.run(t, at);
    if (!t.clamps) {
      finish(t, at, kVecs, one.pixels);
    }
  };
  const auto run_edge = [&](std::int32_t ox) {
    run({1, &tile<1, kVecs, 0>}, ox, inside(ox * a.stride_w - a.pad_left, a.kernel_w, a.in_w));
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

template <int kVecs>
void all_rows(const Panel& t) {
  const Range whole = whole_windows(t.a);
  const SizedTile inner = tile_for<kVecs>(t.a, std::max(1, whole.last - whole.first));
  for (std::int32_t oy = 0; oy < t.a.out_h; ++oy) {
    row<kVecs>(t, oy, whole, inner);
  }
}

}  // namespace

void conv2d(const Conv2dArgs& a) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{a.kernel_h} * a.kernel_w * a.in_c;
  const std::int32_t blocks = blocks_of(a.out_c);
  Panel t{a, a.weights, 0, {}, false};
  t.clamps = is_clamp(a.activation, t.clamp);
  for (; t.block + 2 <= blocks; t.block += 2, t.weights += reduction * kPanel) {
    all_rows<2>(t);
  }
  if (t.block < blocks) {
    all_rows<1>(t);
  }
}

}  // namespace mien::kernels::avx2
