// Register tiles of up to 6 pixels x 16 output channels, or 12 x 8 for a last panel of 8: with 12
// sums, values of x and weights are reused.
#include <algorithm>

#include "kernels/common/avx2.h"
#include "kernels/common/product.h"
#include "kernels/common/product_spot.h"
#include "kernels/common/product_sums.h"
#include "kernels/common/sized_tile.h"

namespace mien::kernels::avx2 {
namespace {

constexpr int kMaxSums = 12;

Vec weights_at(const std::uint16_t* w) { return load_half(w); }
Vec weights_at(const float* w) { return _mm256_loadu_ps(w); }

template <int kPixels, int kVecs, class Weight>
void tile(Spot& s, const Weight* w) {
  constexpr int kSums = partial_sums(kPixels * kVecs);
  const ProductArgs& a = s.a;
  Vec sum[kSums][kPixels][kVecs];
  for (int v = 0; v < kVecs; ++v) {
    const Vec bias = load_half(a.bias + s.panel * kPanel + v * kLanes);
#pragma GCC unroll 12
    for (int p = 0; p < kPixels; ++p) {
      sum[0][p][v] = bias;
      for (int k = 1; k < kSums; ++k) {
        sum[k][p][v] = _mm256_setzero_ps();
      }
    }
  }
  const float* x = s.x;
  std::int32_t left = a.in_blocks;
  do {
    for (int lane = 0; lane < kLanes; lane += kSums) {
      for (int k = 0; k < kSums; ++k, w += kVecs * kLanes) {
        Vec weight[kVecs];
        for (int v = 0; v < kVecs; ++v) {
          weight[v] = weights_at(w + v * kLanes);
        }
#pragma GCC unroll 12
        for (int p = 0; p < kPixels; ++p) {
          const Vec value = _mm256_broadcast_ss(x + p * kLanes + lane + k);
          for (int v = 0; v < kVecs; ++v) {
            sum[k][p][v] = _mm256_fmadd_ps(value, weight[v], sum[k][p][v]);
          }
        }
      }
    }
    x += a.x_plane_elems;
  } while (--left > 0);
  const Vec low = _mm256_set1_ps(a.low), high = _mm256_set1_ps(a.high);
  Cursor at = s.y;
#pragma GCC unroll 12
  for (int p = 0; p < kPixels; ++p, at.advance()) {
    for (int v = 0; v < kVecs; ++v) {
      Vec total = sum[0][p][v];
      for (int k = 1; k < kSums; ++k) {
        total = _mm256_add_ps(total, sum[k][p][v]);
      }
      total = _mm256_min_ps(high, _mm256_max_ps(low, total));
      _mm256_storeu_ps(a.y + at.at(s.panel) + v * a.y_rows.half_elems, total);
    }
  }
  s.y = at;
  s.x += kPixels * kLanes;
}

// Adds the residual to the `pixels` that a tile has stored from `y` on. A separate pass needs less
// code than every tile.
void add_residual(Spot& s, Cursor y, std::int32_t blocks, std::int32_t pixels) {
  const ProductArgs& a = s.a;
  for (std::int32_t p = 0; p < pixels; ++p, y.advance(), s.residual.advance()) {
    for (std::int32_t half = 0; half < blocks; ++half) {
      float* to = a.y + y.at(s.panel) + half * a.y_rows.half_elems;
      const float* r = a.residual + s.residual.at(s.panel) + half * a.residual_rows.half_elems;
      _mm256_storeu_ps(to, _mm256_add_ps(_mm256_loadu_ps(to), _mm256_loadu_ps(r)));
    }
  }
}

template <class Weight>
using Run = void (*)(Spot&, const Weight*);

template <int kVecs, class Weight, int... kSizes>
Tiling<Run<Weight>> one_of(std::int32_t pixels) {
  static constexpr SizedTile<Run<Weight>> kTiles[] = {{kSizes, &tile<kSizes, kVecs, Weight>}...};
  return tiling_of(kTiles, pixels);
}

// Weights are converted to fp32 only if there are pixels for several tiles.
template <int kVecs>
Tiling<Run<float>> tiles_of(std::int32_t pixels, const float*) {
  return kVecs == 2 ? one_of<2, float, 4, 5, 6>(pixels) : one_of<1, float, 7, 9, 12>(pixels);
}
template <int kVecs>
Tiling<Run<std::uint16_t>> tiles_of(std::int32_t pixels, const std::uint16_t*) {
  return kVecs == 2 ? one_of<2, std::uint16_t, 1, 2, 3, 4, 5, 6>(pixels)
                    : one_of<1, std::uint16_t, 1, 2, 4, 6, 9, 12>(pixels);
}

template <int kVecs, class Weight>
void sweep(const ProductArgs& a, std::int32_t panel, const Weight* w) {
  const Tiling<Run<Weight>> tiles = tiles_of<kVecs>(a.pixels, w);
  const auto run = [&](const SizedTile<Run<Weight>>& tile, Spot& spot) {
    const Cursor before = spot.y;
    tile.run(spot, w);
    if (a.residual != nullptr) {
      add_residual(spot, before, kVecs, tile.pixels);
    }
  };
  Spot spot(a, panel, 0);
  for (std::int32_t i = 0; i < tiles.count; ++i) {
    run(tiles.each, spot);
  }
  if (tiles.last.run != nullptr) {
    Spot end(a, panel, a.pixels - tiles.last.pixels);
    run(tiles.last, end);
  }
}

template <int kVecs>
void run_panel(const ProductArgs& a, std::int32_t panel) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{a.in_blocks} * kLanes;
  const std::ptrdiff_t elems = reduction * kVecs * kLanes;
  const std::uint16_t* w = a.weights + panel * reduction * kPanel;
  if (a.fp32_weights == nullptr || a.pixels <= kMaxSums / kVecs || elems > kFp32WeightElems) {
    return sweep<kVecs>(a, panel, w);
  }
  for (std::ptrdiff_t k = 0; k < elems; k += kLanes) {
    _mm256_storeu_ps(a.fp32_weights + k, load_half(w + k));
  }
  sweep<kVecs, float>(a, panel, a.fp32_weights);
}

}  // namespace

void multiply_panels(const ProductArgs& a) {
  const std::int32_t panels = a.out_blocks / 2;
  for (std::int32_t panel = 0; panel < panels; ++panel) {
    run_panel<2>(a, panel);
  }
  if (a.out_blocks % 2 != 0) {
    run_panel<1>(a, panels);
  }
}

}  // namespace mien::kernels::avx2
