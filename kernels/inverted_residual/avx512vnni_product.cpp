// Register tiles of up to 13 pixels x 2 panels, 9 x 3 or 6 x 4, as avx512's, with two elements of
// the sum in each lane. A last panel of 8 takes four elements at once, two in the even lanes and
// two in the odd.
#include <algorithm>

#include "kernels/common/avx512.h"
#include "kernels/common/product_spot.h"
#include "kernels/common/product_sums.h"
#include "kernels/common/sized_tile.h"
#include "kernels/inverted_residual/fixed_product.h"

namespace mien::kernels::avx512vnni {
namespace {

using avx512::kBlock;
using avx512::kPanel;
using avx512::Vec;
using Sum = __m512i;

constexpr std::int32_t kPairElems = 2 * kPanel;  // of a vector of weights

// Some pixels of the panels from `panel` on. A tile moves it behind those it made.
struct FixedSpot {
  FixedSpot(const FixedProduct& product, std::int32_t first_panel, std::int32_t pixel)
      : a(product),
        panel(first_panel),
        x(product.values + std::ptrdiff_t{pixel} * kBlock),
        y(product.to.y_rows, pixel),
        residual(product.to.residual == nullptr ? product.to.y_rows : product.to.residual_rows,
                 pixel) {}
  const FixedProduct& a;
  std::int32_t panel;
  const std::int16_t* x;
  Cursor y, residual;
};

// kCount: 1 or 2 pairs, in every lane or in every two.
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

// Lanes 2i and 2i + 1 added up, i = 0 .. 7.
__m256i sums_of_two(Sum v) {
  v = _mm512_add_epi32(v, _mm512_srli_epi64(v, 32));
  return _mm512_cvtepi64_epi32(v);
}

// Where sums of a tile become numbers: copies of all that is needed, since to the compiler a vector
// that is stored may change anything in memory.
class Target {
 public:
  explicit Target(const FixedSpot& s)
      : panel_(s.panel),
        y_(s.a.to.y),
        residual_(s.a.to.residual),
        half_(s.a.to.y_rows.half_elems),
        residual_half_(s.a.to.residual_rows.half_elems),
        at_(s.y),
        from_(s.residual) {}

  [[nodiscard]] float* y(int v) const { return y_ + at_.at(panel_ + v); }
  [[nodiscard]] const float* residual(int v) const { return residual_ + from_.at(panel_ + v); }
  [[nodiscard]] bool adds() const { return residual_ != nullptr; }
  [[nodiscard]] bool is_strip() const { return half_ == kBlock; }
  [[nodiscard]] std::ptrdiff_t half() const { return half_; }
  [[nodiscard]] std::ptrdiff_t residual_half() const { return residual_half_; }

  // To the next pixel.
  void advance() {
    at_.advance();
    if (adds()) {
      from_.advance();
    }
  }
  void leave(FixedSpot& s) const {
    s.y = at_;
    s.residual = from_;
  }

 private:
  std::int32_t panel_;
  float* y_;
  const float* residual_;
  std::ptrdiff_t half_, residual_half_;
  Cursor at_, from_;
};

template <int kVecs>
struct Finish {
  Vec low, high, step[kVecs], bias[kVecs];

  explicit Finish(const FixedSpot& s)
      : low(_mm512_set1_ps(s.a.to.low)), high(_mm512_set1_ps(s.a.to.high)) {
    for (int v = 0; v < kVecs; ++v) {
      const std::ptrdiff_t channel = std::ptrdiff_t{s.panel + v} * kPanel;
      step[v] = _mm512_mul_ps(_mm512_loadu_ps(s.a.steps + channel), _mm512_set1_ps(s.a.x_step));
      bias[v] = avx512::load_half(s.a.to.bias + channel);
    }
  }
  void store(const Target& to, int v, Sum sum) const {
    Vec y = _mm512_fmadd_ps(_mm512_cvtepi32_ps(sum), step[v], bias[v]);
    y = _mm512_min_ps(high, _mm512_max_ps(low, y));
    if (to.is_strip()) {
      return _mm512_storeu_ps(to.y(v), y);
    }
    if (to.adds()) {
      y = _mm512_add_ps(y, avx512::load_blocks(to.residual(v), to.residual_half(), true));
    }
    avx512::store_blocks(to.y(v), to.half(), true, y);
  }
};

// The same of the last 8.
struct HalfFinish {
  __m256 low, high, step, bias;

  explicit HalfFinish(const FixedSpot& s)
      : low(_mm256_set1_ps(s.a.to.low)), high(_mm256_set1_ps(s.a.to.high)) {
    const std::ptrdiff_t channel = std::ptrdiff_t{s.panel} * kPanel;
    step = _mm256_mul_ps(_mm256_loadu_ps(s.a.steps + channel), _mm256_set1_ps(s.a.x_step));
    bias = _mm512_castps512_ps256(avx512::load_half(s.a.to.bias + channel, 0xFF));
  }
  void store(const Target& to, int, Sum sum) const {
    __m256 y = _mm256_fmadd_ps(_mm256_cvtepi32_ps(sums_of_two(sum)), step, bias);
    y = _mm256_min_ps(high, _mm256_max_ps(low, y));
    if (to.adds()) {
      y = _mm256_add_ps(y, _mm256_loadu_ps(to.residual(0)));
    }
    _mm256_storeu_ps(to.y(0), y);
  }
};

// kCount pairs at once.
template <int kPixels, int kVecs, int kCount, class Finish>
void multiply(FixedSpot& s, const std::int16_t* w) {
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
  const Finish finish(s);
  Target to(s);
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
  to.leave(s);
  s.x += kPixels * kBlock;
}

template <int kPixels, int kVecs>
void tile(FixedSpot& s, const std::int16_t* w) {
  multiply<kPixels, kVecs, 1, Finish<kVecs>>(s, w);
}
template <int kPixels>
void half_tile(FixedSpot& s, const std::int16_t* w) {
  multiply<kPixels, 1, 2, HalfFinish>(s, w);
}

using Run = void (*)(FixedSpot&, const std::int16_t*);
using Tile = SizedTile<Run>;

template <int kVecs, int... kSizes>
Tiling<Run> one_of(std::int32_t pixels) {
  static constexpr Tile kTiles[] = {{kSizes, &tile<kSizes, kVecs>}...};
  return tiling_of(kTiles, pixels);
}

// `panels` 0: the last panel of 8.
Tiling<Run> tiles_of(std::int32_t panels, std::int32_t pixels) {
  static constexpr Tile kHalf[] = {{1, &half_tile<1>},  {2, &half_tile<2>}, {4, &half_tile<4>},
                                   {6, &half_tile<6>},  {9, &half_tile<9>}, {11, &half_tile<11>},
                                   {13, &half_tile<13>}};
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

void sweep(const FixedProduct& a, std::int32_t first, std::int32_t panels) {
  const std::int16_t* w = a.pairs + std::ptrdiff_t{first} * a.to.in_blocks * kBlock * kPanel;
  const Tiling<Run> tiles = tiles_of(panels, a.to.pixels);
  FixedSpot spot(a, first, 0);
  for (std::int32_t i = 0; i < tiles.count; ++i) {
    tiles.each.run(spot, w);
  }
  if (tiles.last.run != nullptr) {
    FixedSpot end(a, first, a.to.pixels - tiles.last.pixels);
    tiles.last.run(end, w);
  }
}

}  // namespace

void multiply_fixed(const FixedProduct& a) {
  const std::int32_t panels = a.to.out_blocks / 2;
  const std::int32_t at_once = a.to.pixels <= 6 ? 4 : a.to.pixels == 9 ? 3 : 2;
  std::int32_t done = 0;
  for (std::int32_t count = at_once; count > 0; count = count > 2 ? 2 : count - 1) {
    for (; done + count <= panels; done += count) {
      sweep(a, done, count);
    }
  }
  if (a.to.out_blocks % 2 != 0) {
    sweep(a, done, 0);
  }
}

}  // namespace mien::kernels::avx512vnni
