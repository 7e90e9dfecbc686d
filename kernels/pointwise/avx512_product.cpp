// Register tiles of up to 13 pixels x 2 panels, 9 x 3 or 6 x 4, limited by the number of registers.
// Values of x and weights are reused. A last panel of 8 takes two elements of the sum at
// once, one in the even lanes and one in the odd.
#include "kernels/common/product.h"

#include <algorithm>
#include <type_traits>

#include "kernels/common/avx512.h"
#include "kernels/common/product_spot.h"
#include "kernels/common/product_sums.h"
#include "kernels/common/sized_tile.h"

namespace mien::kernels::avx512 {
namespace {

constexpr int kMaxPixels = 13;

Vec weights_at(const std::uint16_t* w) { return load_half(w); }
Vec weights_at(const float* w) { return _mm512_loadu_ps(w); }

Vec pair_at(const float* x) {
  long long pair;
  __builtin_memcpy(&pair, x, sizeof pair);
  return _mm512_castsi512_ps(_mm512_set1_epi64(pair));
}

// Reorders w0 of 8 outputs, w1 of 8 outputs to w0, w1 of each output.
Vec interleaved(Vec w) {
  const __m512i order = _mm512_setr_epi32(0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15);
  return _mm512_permutexvar_ps(order, w);
}
Vec pairs_at(const std::uint16_t* w) { return interleaved(load_half(w)); }
Vec pairs_at(const float* w) { return _mm512_loadu_ps(w); }

// Sums of lanes 2i and 2i + 1, i = 0 .. 7.
__m256 sums_of_pairs(Vec v) {
  v = _mm512_add_ps(v, _mm512_permute_ps(v, 0xB1));
  const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 0, 2, 4, 6, 8, 10, 12, 14);
  return _mm512_castps512_ps256(_mm512_permutexvar_ps(even, v));
}

// Stores a tile with a residual.
template <int kPixels, int kVecs>
void store_sum(Spot& s, const Vec (&sum)[kPixels][kVecs]) {
  const ProductArgs& a = s.a;
  const Vec low = _mm512_set1_ps(a.low), high = _mm512_set1_ps(a.high);
  Cursor to = s.y, from = s.residual;
#pragma GCC unroll 16
  for (int p = 0; p < kPixels; ++p, to.advance(), from.advance()) {
    for (int v = 0; v < kVecs; ++v) {
      const float* r = a.residual + from.at(s.panel + v);
      const Vec total = _mm512_min_ps(high, _mm512_max_ps(low, sum[p][v]));
      store_blocks(a.y + to.at(s.panel + v), a.y_rows.half_elems, true,
                   _mm512_add_ps(total, load_blocks(r, a.residual_rows.half_elems, true)));
    }
  }
  s.y = to;
  s.residual = from;
  s.x += kPixels * kBlock;
}

// Whether tiles add the residual themselves. Only those with many pixels do, to limit code size.
template <class Weight>
constexpr bool adds_inside(std::int32_t panels) {
  return std::is_same_v<Weight, float> && panels > 0;
}

template <int kPixels, int kVecs, class Weight>
void tile(Spot& s, const Weight* w) {
  constexpr int kSums = partial_sums(kPixels * kVecs);
  const ProductArgs& a = s.a;
  const std::ptrdiff_t panel = std::ptrdiff_t{a.in_blocks} * kBlock * kPanel;
  Vec sum[kSums][kPixels][kVecs];
  for (int v = 0; v < kVecs; ++v) {
    const Vec bias = load_half(a.bias + (s.panel + v) * kPanel);
#pragma GCC unroll 16
    for (int p = 0; p < kPixels; ++p) {
      sum[0][p][v] = bias;
      for (int k = 1; k < kSums; ++k) {
        sum[k][p][v] = _mm512_setzero_ps();
      }
    }
  }
  const float* x = s.x;
  std::int32_t left = a.in_blocks;
  do {
#pragma GCC unroll 1
    for (int lane = 0; lane < kBlock; lane += kSums) {
      for (int k = 0; k < kSums; ++k, w += kPanel) {
        Vec weight[kVecs];
        for (int v = 0; v < kVecs; ++v) {
          weight[v] = weights_at(w + v * panel);
        }
#pragma GCC unroll 16
        for (int p = 0; p < kPixels; ++p) {
          const Vec value = _mm512_set1_ps(x[p * kBlock + lane + k]);
          for (int v = 0; v < kVecs; ++v) {
            sum[k][p][v] = _mm512_fmadd_ps(value, weight[v], sum[k][p][v]);
          }
        }
      }
    }
    x += a.x_plane_elems;
  } while (--left > 0);
  const Vec low = _mm512_set1_ps(a.low), high = _mm512_set1_ps(a.high);
  const std::ptrdiff_t half = a.y_rows.half_elems;
  Cursor at = s.y;
  if constexpr (adds_inside<Weight>(kVecs)) {
    static_assert(kSums == 1);
    if (a.residual != nullptr) {
      return store_sum<kPixels, kVecs>(s, sum[0]);
    }
  }
#pragma GCC unroll 16
  for (int p = 0; p < kPixels; ++p, at.advance()) {
    for (int v = 0; v < kVecs; ++v) {
      Vec total = sum[0][p][v];
      for (int k = 1; k < kSums; ++k) {
        total = _mm512_add_ps(total, sum[k][p][v]);
      }
      total = _mm512_min_ps(high, _mm512_max_ps(low, total));
      store_blocks(a.y + at.at(s.panel + v), half, true, total);
    }
  }
  s.y = at;
  s.x += kPixels * kBlock;
}

template <int kPixels, class Weight>
void half_tile(Spot& s, const Weight* w) {
  constexpr int kSums = partial_sums(kPixels);
  const ProductArgs& a = s.a;
  Vec sum[kSums][kPixels];
  for (auto& partial : sum) {
#pragma GCC unroll 16
    for (Vec& one : partial) {
      one = _mm512_setzero_ps();
    }
  }
  const float* x = s.x;
  std::int32_t left = a.in_blocks;
  do {
#pragma GCC unroll 1
    for (int lane = 0; lane < kBlock; lane += 2 * kSums) {
      for (int k = 0; k < kSums; ++k, w += kPanel) {
        const Vec weight = pairs_at(w);
#pragma GCC unroll 16
        for (int p = 0; p < kPixels; ++p) {
          sum[k][p] = _mm512_fmadd_ps(pair_at(x + p * kBlock + lane + 2 * k), weight, sum[k][p]);
        }
      }
    }
    x += a.x_plane_elems;
  } while (--left > 0);
  const __m256 low = _mm256_set1_ps(a.low), high = _mm256_set1_ps(a.high);
  const __m256 bias = _mm512_castps512_ps256(load_half(a.bias + s.panel * kPanel, 0xFF));
  Cursor at = s.y;
#pragma GCC unroll 16
  for (int p = 0; p < kPixels; ++p, at.advance()) {
    Vec pairs = sum[0][p];
    for (int k = 1; k < kSums; ++k) {
      pairs = _mm512_add_ps(pairs, sum[k][p]);
    }
    const __m256 total = _mm256_add_ps(sums_of_pairs(pairs), bias);
    _mm256_storeu_ps(a.y + at.at(s.panel), _mm256_min_ps(high, _mm256_max_ps(low, total)));
  }
  s.y = at;
  s.x += kPixels * kBlock;
}

// Adds the residual to the `pixels` that a tile has stored from `y` on. `panels` 0: last panel
// of 8.
void add_residual(Spot& s, Cursor y, std::int32_t panels, std::int32_t pixels) {
  const ProductArgs& a = s.a;
  const bool both = panels > 0;
  for (std::int32_t p = 0; p < pixels; ++p, y.advance(), s.residual.advance()) {
    for (std::int32_t panel = s.panel; panel < s.panel + (both ? panels : 1); ++panel) {
      float* to = a.y + y.at(panel);
      const Vec sum = load_blocks(to, a.y_rows.half_elems, both);
      const float* r = a.residual + s.residual.at(panel);
      store_blocks(to, a.y_rows.half_elems, both,
                   _mm512_add_ps(sum, load_blocks(r, a.residual_rows.half_elems, both)));
    }
  }
}

template <class Weight>
using Run = void (*)(Spot&, const Weight*);

// `kVecs` 0: the last panel of 8.
template <int kVecs, class Weight, int... kSizes>
Tiling<Run<Weight>> one_of(std::int32_t pixels) {
  if constexpr (kVecs == 0) {
    static constexpr SizedTile<Run<Weight>> kTiles[] = {{kSizes, &half_tile<kSizes, Weight>}...};
    return tiling_of(kTiles, pixels);
  } else {
    static constexpr SizedTile<Run<Weight>> kTiles[] = {{kSizes, &tile<kSizes, kVecs, Weight>}...};
    return tiling_of(kTiles, pixels);
  }
}

Tiling<Run<float>> tiles_of(std::int32_t panels, std::int32_t pixels, const float*) {
  switch (panels) {
    case 0:
      return one_of<0, float, 8, 13>(pixels);
    case 1:
      return one_of<1, float, 8, 13>(pixels);
    default:
      return one_of<2, float, 8, 13>(pixels);
  }
}

Tiling<Run<std::uint16_t>> tiles_of(std::int32_t panels, std::int32_t pixels,
                                    const std::uint16_t*) {
  switch (panels) {
    case 0:
      return one_of<0, std::uint16_t, 1, 2, 4, 6, 9, 11, 13>(pixels);
    case 1:
      return one_of<1, std::uint16_t, 1, 2, 4, 6, 9, 11, 13>(pixels);
    case 2:
      return one_of<2, std::uint16_t, 1, 2, 4, 6, 7, 8, 9, 10, 11, 12, 13>(pixels);
    case 3:
      return one_of<3, std::uint16_t, 9>(pixels);
    default:
      return one_of<4, std::uint16_t, 1, 2, 3, 4, 5, 6>(pixels);
  }
}

template <class Weight>
void sweep(const ProductArgs& a, std::int32_t first, std::int32_t panels, const Weight* w) {
  const bool adds_after = a.residual != nullptr && !adds_inside<Weight>(panels);
  const Tiling<Run<Weight>> tiles = tiles_of(panels, a.pixels, w);
  const auto run = [&](const SizedTile<Run<Weight>>& tile, Spot& spot) {
    const Cursor before = spot.y;
    tile.run(spot, w);
    if (adds_after) {
      add_residual(spot, before, panels, tile.pixels);
    }
  };
  Spot spot(a, first, 0);
  for (std::int32_t i = 0; i < tiles.count; ++i) {
    run(tiles.each, spot);
  }
  if (tiles.last.run != nullptr) {
    Spot end(a, first, a.pixels - tiles.last.pixels);
    run(tiles.last, end);
  }
}

void widen(const std::uint16_t* w, std::ptrdiff_t elems, bool pairs, float* fp32_weights) {
  for (std::ptrdiff_t k = 0; k < elems; k += kPanel) {
    _mm512_storeu_ps(fp32_weights + k, pairs ? pairs_at(w + k) : load_half(w + k));
  }
}

}  // namespace

void multiply_panels(const ProductArgs& a) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{a.in_blocks} * kBlock;
  const std::int32_t panels = a.out_blocks / 2;
  const std::int32_t at_once = a.pixels <= 6 ? 4 : a.pixels == 9 ? 3 : 2;
  const bool widened = a.fp32_weights != nullptr && a.pixels > 3 * kMaxPixels &&
                       reduction * 2 * kPanel <= kFp32WeightElems;
  const auto run = [&](std::int32_t first, std::int32_t count) {
    const std::uint16_t* w = a.weights + first * reduction * kPanel;
    if (!widened) {
      return sweep(a, first, count, w);
    }
    widen(w, reduction * (count == 0 ? kBlock : count * kPanel), count == 0, a.fp32_weights);
    sweep<float>(a, first, count, a.fp32_weights);
  };
  std::int32_t done = 0;
  for (std::int32_t count = at_once; count > 0; count = count > 2 ? 2 : count - 1) {
    for (; done + count <= panels; done += count) {
      run(done, count);
    }
  }
  if (a.out_blocks % 2 != 0) {
    run(done, 0);
  }
}

}  // namespace mien::kernels::avx512
