// Register tiles of up to 6 pixels x 16 output channels, or 12 x 8 for a last panel of 8: 12 sums,
// so that a value of x and the weights serve several of them.
#include <utility>

#include "kernels/common/avx2.h"
#include "kernels/common/product.h"

namespace mien::kernels::avx2 {
namespace {

constexpr int kMostSums = 12;

// Few sums are split into partial ones: eight at least hide the latency of the multiply-adds.
constexpr int partial_sums(int sums) { return sums >= 8 ? 1 : sums >= 4 ? 2 : 4; }

// One pixel after another.
class Cursor {
 public:
  explicit Cursor(const PixelRows& rows) : rows_(&rows) {}
  [[nodiscard]] std::ptrdiff_t at(std::int32_t panel) const {
    return pixel_ + panel * rows_->panel_elems;
  }
  void advance() {
    pixel_ += rows_->pixel_elems;
    if (++column_ == rows_->row_pixels) {
      column_ = 0;
      pixel_ += rows_->row_gap_elems;
    }
  }

 private:
  std::ptrdiff_t pixel_ = 0;
  std::int32_t column_ = 0;
  const PixelRows* rows_;
};

// One panel over all pixels, tile by tile.
struct Sweep {
  const ProductArgs& a;
  std::int32_t panel;
  const float* x;
  Cursor y;
};

Vec weights_at(const std::uint16_t* w) { return load_half(w); }
Vec weights_at(const float* w) { return _mm256_loadu_ps(w); }

template <int kPixels, int kVecs, class Weight>
void tile(Sweep& s, const Weight* w) {
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

// Onto the `pixels` that a tile has just stored: once here is less code than in every tile.
void add_residual(const Sweep& s, Cursor y, Cursor& residual, std::int32_t blocks,
                  std::int32_t pixels) {
  const ProductArgs& a = s.a;
  for (std::int32_t p = 0; p < pixels; ++p, y.advance(), residual.advance()) {
    for (std::int32_t half = 0; half < blocks; ++half) {
      float* to = a.y + y.at(s.panel) + half * a.y_rows.half_elems;
      const float* r = a.residual + residual.at(s.panel) + half * a.residual_rows.half_elems;
      _mm256_storeu_ps(to, _mm256_add_ps(_mm256_loadu_ps(to), _mm256_loadu_ps(r)));
    }
  }
}

template <class Weight>
using Tile = void (*)(Sweep&, const Weight*);

// Tiles of kFirst, kFirst + 1, .. pixels.
template <int kVecs, int kFirst, class Weight, int... kMore>
Tile<Weight> tile_from(std::int32_t pixels, std::integer_sequence<int, kMore...>) {
  static constexpr Tile<Weight> kTiles[] = {&tile<kFirst + kMore, kVecs, Weight>...};
  return kTiles[pixels - kFirst];
}

// Of several tiles none is smaller than half of the largest.
template <int kVecs>
Tile<float> tile_of(std::int32_t pixels, const float*) {
  constexpr int kMost = kMostSums / kVecs;
  return tile_from<kVecs, kMost / 2, float>(pixels,
                                            std::make_integer_sequence<int, kMost / 2 + 1>());
}
template <int kVecs>
Tile<std::uint16_t> tile_of(std::int32_t pixels, const std::uint16_t*) {
  return tile_from<kVecs, 1, std::uint16_t>(pixels,
                                            std::make_integer_sequence<int, kMostSums / kVecs>());
}

template <int kVecs>
std::int32_t tile_count(const ProductArgs& a) {
  constexpr int kMost = kMostSums / kVecs;
  return (a.pixels + kMost - 1) / kMost;
}

// Tiles of nearly equal size: 9 pixels are 5 + 4, not 6 + 3.
template <int kVecs, class Weight>
void sweep(const ProductArgs& a, std::int32_t panel, const Weight* w) {
  Sweep s{a, panel, a.x, Cursor(a.y_rows)};
  Cursor residual(a.residual_rows);
  const std::int32_t tiles = tile_count<kVecs>(a);
  const std::int32_t least = a.pixels / tiles, larger = a.pixels % tiles;
  const Tile<Weight> more = tile_of<kVecs>(least + (larger > 0 ? 1 : 0), w);
  const Tile<Weight> less = tile_of<kVecs>(least, w);
  for (std::int32_t i = 0; i < tiles; ++i) {
    const Cursor before = s.y;
    (i < larger ? more : less)(s, w);
    if (a.residual != nullptr) {
      add_residual(s, before, residual, kVecs, least + (i < larger ? 1 : 0));
    }
  }
}

template <int kVecs>
void run_panel(const ProductArgs& a, std::int32_t panel) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{a.in_blocks} * kLanes;
  const std::ptrdiff_t elems = reduction * kVecs * kLanes;
  const std::uint16_t* w = a.weights + panel * reduction * kPanel;
  if (a.wide == nullptr || tile_count<kVecs>(a) < 2 || elems > kWideElems) {
    return sweep<kVecs>(a, panel, w);
  }
  for (std::ptrdiff_t k = 0; k < elems; k += kLanes) {
    _mm256_storeu_ps(a.wide + k, load_half(w + k));
  }
  sweep<kVecs, float>(a, panel, a.wide);
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
