// Register tiles of up to 13 pixels x 2 panels, 9 x 3 or 6 x 4, as in avx512_product.cpp, with two
// elements of the sum in each lane. A last panel of 8 takes four elements at once, two in the even
// lanes and two in the odd.
#include <algorithm>

#include "kernels/common/avx512.h"
#include "kernels/common/product_spot.h"
#include "kernels/common/product_sums.h"
#include "kernels/common/sized_tile.h"
#include "kernels/inverted_residual/quantized_product.h"

namespace mien::kernels::avx512vnni {
namespace {

using avx512::kBlock;
using avx512::kPanel;
using avx512::Vec;
using Sum = __m512i;

constexpr std::int32_t kPairElems = 2 * kPanel;  // weights per vector

// Output positions of a tile. Each tile has its own copy, which stores cannot alias.

// Rows of a strip: panels of 16 floats, without residual.
class StripRows {
 public:
  StripRows(const ProductArgs& to, std::int32_t panel, std::int32_t pixel)
      : y_(to.y + Cursor(to.y_rows, pixel).at(panel)),
        panel_(to.y_rows.panel_elems),
        gap_(to.y_rows.row_gap_elems),
        column_(pixel % to.y_rows.row_pixels),
        columns_(to.y_rows.row_pixels) {}

  void store(int v, Vec value) const { _mm512_storeu_ps(y_ + v * panel_, value); }
  void store_half(__m256 value) const { _mm256_storeu_ps(y_, value); }
  void advance() {
    y_ += kPanel;
    if (++column_ == columns_) {
      column_ = 0;
      y_ += gap_;
    }
  }

 private:
  float* y_;
  std::ptrdiff_t panel_, gap_;
  std::int32_t column_, columns_;
};

// Contiguous rows of pixels of a map, with an optional residual.
class MapRows {
 public:
  MapRows(const ProductArgs& to, std::int32_t panel, std::int32_t pixel)
      : y_(to.y + panel * to.y_rows.panel_elems + std::ptrdiff_t{pixel} * kBlock),
        half_(to.y_rows.half_elems),
        panel_(to.y_rows.panel_elems) {
    if (to.residual != nullptr) {
      const PixelRows& rows = to.residual_rows;
      residual_ = to.residual + Cursor(rows, pixel).at(panel);
      residual_half_ = rows.half_elems;
      residual_panel_ = rows.panel_elems;
      gap_ = rows.row_gap_elems;
      column_ = pixel % rows.row_pixels;
      columns_ = rows.row_pixels;
    }
  }

  void store(int v, Vec value) const {
    if (residual_ != nullptr) {
      value = _mm512_add_ps(
          value, avx512::load_blocks(residual_ + v * residual_panel_, residual_half_, true));
    }
    avx512::store_blocks(y_ + v * panel_, half_, true, value);
  }
  void store_half(__m256 value) const {
    if (residual_ != nullptr) {
      value = _mm256_add_ps(value, _mm256_loadu_ps(residual_));
    }
    _mm256_storeu_ps(y_, value);
  }
  void advance() {
    y_ += kBlock;
    if (residual_ != nullptr) {
      residual_ += kBlock;
      if (++column_ == columns_) {
        column_ = 0;
        residual_ += gap_;
      }
    }
  }

 private:
  float* y_;
  std::ptrdiff_t half_, panel_;
  const float* residual_ = nullptr;
  std::ptrdiff_t residual_half_ = 0, residual_panel_ = 0, gap_ = 0;
  std::int32_t column_ = 0, columns_ = 0;
};

// Position of a tile: a panel and a pixel. Each tile advances it past its own pixels.
template <class Rows>
struct QuantizedSpot {
  QuantizedSpot(const QuantizedProduct& product, std::int32_t first_panel, std::int32_t pixel)
      : a(product),
        panel(first_panel),
        x(product.values + std::ptrdiff_t{pixel} * kBlock),
        to(product.to, first_panel, pixel) {}
  const QuantizedProduct& a;
  std::int32_t panel;
  const std::int16_t* x;
  Rows to;
};

// Broadcasts 1 pair to every lane, or 2 pairs to every two lanes.
template <int kCount>
Sum broadcast(const std::int16_t* x) {
  if constexpr (kCount == 1) {
    int pair;
    __builtin_memcpy(&pair, x, sizeof pair);
    return _mm512_set1_epi32(pair);
  } else {
    long long pairs;
    __builtin_memcpy(&pairs, x, sizeof pairs);
    return _mm512_set1_epi64(pairs);
  }
}

// Sums of lanes 2i and 2i + 1, i = 0 .. 7.
__m256i sums_of_two(Sum v) {
  v = _mm512_add_epi32(v, _mm512_srli_epi64(v, 32));
  return _mm512_cvtepi64_epi32(v);
}

// Converts integer sums to results.
template <int kVecs>
struct Finish {
  Vec low, high, scale[kVecs], bias[kVecs];

  Finish(const QuantizedProduct& a, std::int32_t panel)
      : low(_mm512_set1_ps(a.to.low)), high(_mm512_set1_ps(a.to.high)) {
    for (int v = 0; v < kVecs; ++v) {
      const std::ptrdiff_t channel = std::ptrdiff_t{panel + v} * kPanel;
      scale[v] = _mm512_mul_ps(_mm512_loadu_ps(a.scales + channel), _mm512_set1_ps(a.x_scale));
      bias[v] = avx512::load_half(a.to.bias + channel);
    }
  }
  template <class Rows>
  void store(const Rows& to, int v, Sum sum) const {
    const Vec y = _mm512_fmadd_ps(_mm512_cvtepi32_ps(sum), scale[v], bias[v]);
    to.store(v, _mm512_min_ps(high, _mm512_max_ps(low, y)));
  }
};

// The same for a last panel of 8.
struct HalfFinish {
  __m256 low, high, scale, bias;

  HalfFinish(const QuantizedProduct& a, std::int32_t panel)
      : low(_mm256_set1_ps(a.to.low)), high(_mm256_set1_ps(a.to.high)) {
    const std::ptrdiff_t channel = std::ptrdiff_t{panel} * kPanel;
    scale = _mm256_mul_ps(_mm256_loadu_ps(a.scales + channel), _mm256_set1_ps(a.x_scale));
    bias = _mm512_castps512_ps256(avx512::load_half(a.to.bias + channel, 0xFF));
  }
  template <class Rows>
  void store(const Rows& to, int, Sum sum) const {
    const __m256 y = _mm256_fmadd_ps(_mm256_cvtepi32_ps(sums_of_two(sum)), scale, bias);
    to.store_half(_mm256_min_ps(high, _mm256_max_ps(low, y)));
  }
};

// Adds kCount pairs at once.
template <int kPixels, int kVecs, int kCount, class Finish, class Rows>
void multiply(QuantizedSpot<Rows>& s, const std::int16_t* w) {
  constexpr int kStep = 2 * kCount;
  constexpr int kSums = std::min(partial_sums(kPixels * kVecs), kBlock / kStep);
  const std::ptrdiff_t panel = std::ptrdiff_t{s.a.to.in_blocks} * kBlock * kPanel;
  Sum sum[kSums][kPixels][kVecs];
  for (int k = 0; k < kSums; ++k) {
#pragma GCC unroll 16
    for (int p = 0; p < kPixels; ++p) {
      for (int v = 0; v < kVecs; ++v) {
        sum[k][p][v] = _mm512_setzero_si512();
      }
    }
  }
  const std::int16_t* x = s.x;
  std::int32_t left = s.a.to.in_blocks;
  do {
#pragma GCC unroll 1
    for (int lane = 0; lane < kBlock; lane += kStep * kSums) {
      for (int k = 0; k < kSums; ++k, w += kPairElems) {
        Sum weight[kVecs];
        for (int v = 0; v < kVecs; ++v) {
          weight[v] = _mm512_loadu_si512(w + v * panel);
        }
#pragma GCC unroll 16
        for (int p = 0; p < kPixels; ++p) {
          const Sum value = broadcast<kCount>(x + p * kBlock + lane + kStep * k);
          for (int v = 0; v < kVecs; ++v) {
            sum[k][p][v] = _mm512_dpwssd_epi32(sum[k][p][v], value, weight[v]);
          }
        }
      }
    }
    x += s.a.plane_elems;
  } while (--left > 0);
  const Finish finish(s.a, s.panel);
  Rows to = s.to;
#pragma GCC unroll 16
  for (int p = 0; p < kPixels; ++p) {
    for (int v = 0; v < kVecs; ++v) {
      Sum total = sum[0][p][v];
      for (int k = 1; k < kSums; ++k) {
        total = _mm512_add_epi32(total, sum[k][p][v]);
      }
      finish.store(to, v, total);
    }
    to.advance();
  }
  s.to = to;
  s.x += kPixels * kBlock;
}

template <class Rows>
class Tiles {
 public:
  using Spot = QuantizedSpot<Rows>;
  using Run = void (*)(Spot&, const std::int16_t*);

  // `panels` 0: the last panel of 8.
  static Tiling<Run> of(std::int32_t panels, std::int32_t pixels) {
    static constexpr Tile kHalf[] = {{1, &half<1>}, {2, &half<2>},   {4, &half<4>},  {6, &half<6>},
                                     {9, &half<9>}, {11, &half<11>}, {13, &half<13>}};
    switch (panels) {
      case 0:
        return tiling_of(kHalf, pixels);
      case 1:
        return one_of<1, 1, 2, 4, 6, 9, 11, 13>(pixels);
      case 2:
        return one_of<2, 1, 2, 4, 6, 7, 8, 9, 10, 11, 12, 13>(pixels);
      case 3:
        return one_of<3, 9>(pixels);
      default:
        return one_of<4, 1, 2, 3, 4, 5, 6>(pixels);
    }
  }

 private:
  using Tile = SizedTile<Run>;

  template <int kPixels, int kVecs>
  static void whole(Spot& s, const std::int16_t* w) {
    multiply<kPixels, kVecs, 1, Finish<kVecs>>(s, w);
  }
  template <int kPixels>
  static void half(Spot& s, const std::int16_t* w) {
    multiply<kPixels, 1, 2, HalfFinish>(s, w);
  }

  template <int kVecs, int... kSizes>
  static Tiling<Run> one_of(std::int32_t pixels) {
    static constexpr Tile kTiles[] = {{kSizes, &whole<kSizes, kVecs>}...};
    return tiling_of(kTiles, pixels);
  }
};

template <class Rows>
void sweep(const QuantizedProduct& a, std::int32_t first, std::int32_t panels) {
  const std::int16_t* w = a.pairs + std::ptrdiff_t{first} * a.to.in_blocks * kBlock * kPanel;
  const auto tiles = Tiles<Rows>::of(panels, a.to.pixels);
  QuantizedSpot<Rows> spot(a, first, 0);
  for (std::int32_t i = 0; i < tiles.count; ++i) {
    tiles.each.run(spot, w);
  }
  if (tiles.last.run != nullptr) {
    QuantizedSpot<Rows> end(a, first, a.to.pixels - tiles.last.pixels);
    tiles.last.run(end, w);
  }
}

template <class Rows>
void multiply_to(const QuantizedProduct& a) {
  const std::int32_t panels = a.to.out_blocks / 2;
  const std::int32_t at_once = a.to.pixels <= 6 ? 4 : a.to.pixels == 9 ? 3 : 2;
  std::int32_t done = 0;
  for (std::int32_t count = at_once; count > 0; count = count > 2 ? 2 : count - 1) {
    for (; done + count <= panels; done += count) {
      sweep<Rows>(a, done, count);
    }
  }
  if (a.to.out_blocks % 2 != 0) {
    sweep<Rows>(a, done, 0);
  }
}

}  // namespace

void multiply_quantized_to_strip(const QuantizedProduct& a) { multiply_to<StripRows>(a); }
void multiply_quantized_to_map(const QuantizedProduct& a) { multiply_to<MapRows>(a); }

}  // namespace mien::kernels::avx512vnni
