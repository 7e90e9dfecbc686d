// Register tiles of up to 13 pixels x 2 panels, 9 x 3 or 6 x 4, as in avx512_product.cpp. Each lane
// multiplies 4 bytes at once: two elements of the sum of 16 bits, or four of 8. A last panel of 8
// multiplies 8 bytes, 4 in the even lanes and 4 in the odd.
//
// A tile only leaves integer sums; loops shared by tiles of all sizes convert them, because that
// needs a fifth of the code.
#include <algorithm>

#include "kernels/common/avx512.h"
#include "kernels/common/pixel_pointer.h"
#include "kernels/common/product_sums.h"
#include "kernels/common/sized_tile.h"
#include "kernels/inverted_residual/quantized_product.h"

namespace mien::kernels::avx512vnni {
namespace {

using avx512::kBlock;
using avx512::kPanel;
using avx512::Vec;
using Sum = __m512i;

constexpr std::int32_t kPairElems = 2 * kPanel;  // weights of 16 bits per vector
constexpr int kMaxSums = 27;                     // of a tile

// Aligned, because stores that cross cache lines are slow.
struct alignas(64) Sums {
  std::int32_t of[kMaxSums][kPanel];  // [pixel][panel][16]
};

// Add the products of 4 bytes to each lane.
struct Int16 {
  static Sum add(Sum sum, Sum value, Sum weight) { return _mm512_dpwssd_epi32(sum, value, weight); }
};
struct Int8 {
  static Sum add(Sum sum, Sum value, Sum weight) { return _mm512_dpbusd_epi32(sum, value, weight); }
};

// Broadcasts 4 bytes to every lane, or 8 bytes to every two lanes.
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

// Scales and clamps the sums of kVecs panels.
template <int kVecs>
struct Finish {
  Vec low, high, scale[kVecs], bias[kVecs];

  Finish(const QuantizedProduct& a, std::int32_t panel)
      : low(_mm512_set1_ps(a.to.low)), high(_mm512_set1_ps(a.to.high)) {
    for (int v = 0; v < kVecs; ++v) {
      const std::ptrdiff_t channel = std::ptrdiff_t{panel + v} * kPanel;
      scale[v] = _mm512_mul_ps(_mm512_loadu_ps(a.scales + channel), _mm512_set1_ps(a.x_scale));
      bias[v] = avx512::load_half(a.to.bias + channel);
      if (a.is_int8()) {
        const Vec shift =
            _mm512_mul_ps(_mm512_loadu_ps(a.sums + channel), _mm512_set1_ps(a.x_shift));
        bias[v] = _mm512_fnmadd_ps(shift, scale[v], bias[v]);
      }
    }
  }
  template <bool kResidual>
  void store(const Sums& sums, std::int32_t pixel, const PixelPointer<float>& to,
             const PixelPointer<const float>& residual) const {
    for (int v = 0; v < kVecs; ++v) {
      const Sum sum = _mm512_loadu_si512(sums.of[pixel * kVecs + v]);
      Vec y = _mm512_fmadd_ps(_mm512_cvtepi32_ps(sum), scale[v], bias[v]);
      y = _mm512_min_ps(high, _mm512_max_ps(low, y));
      if constexpr (kResidual) {
        y = _mm512_add_ps(
            y, avx512::load_blocks(residual.at + v * residual.panel, residual.half, true));
      }
      avx512::store_blocks(to.at + v * to.panel, to.half, true, y);
    }
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
    if (a.is_int8()) {
      const __m256 shift =
          _mm256_mul_ps(_mm256_loadu_ps(a.sums + channel), _mm256_set1_ps(a.x_shift));
      bias = _mm256_fnmadd_ps(shift, scale, bias);
    }
  }
  template <bool kResidual>
  void store(const Sums& sums, std::int32_t pixel, const PixelPointer<float>& to,
             const PixelPointer<const float>& residual) const {
    const __m256i sum = sums_of_two(_mm512_loadu_si512(sums.of[pixel]));
    __m256 y = _mm256_fmadd_ps(_mm256_cvtepi32_ps(sum), scale, bias);
    y = _mm256_min_ps(high, _mm256_max_ps(low, y));
    if constexpr (kResidual) {
      y = _mm256_add_ps(y, _mm256_loadu_ps(residual.at));
    }
    _mm256_storeu_ps(to.at, y);
  }
};

template <class Finish, bool kResidual>
void convert(const Finish& by, const Sums& sums, std::int32_t pixels, PixelPointer<float>& y,
             PixelPointer<const float>& residual) {
  const Finish finish = by;
  PixelPointer<float> to = y;
  PixelPointer<const float> r = residual;
  for (std::int32_t p = 0; p < pixels; ++p, to.advance()) {
    finish.template store<kResidual>(sums, p, to, r);
    if constexpr (kResidual) {
      r.advance();
    }
  }
  y = to;
  residual = r;
}

using Run = void (*)(const QuantizedProduct&, const std::int16_t* x, const std::int16_t* w, Sums&);

// Multiplies 4 kCount bytes at once.
template <class Multiply, int kPixels, int kVecs, int kCount>
void sums_of(const QuantizedProduct& a, const std::int16_t* x, const std::int16_t* w, Sums& to) {
  static_assert(kPixels * kVecs <= kMaxSums);
  constexpr int kStep = 2 * kCount;
  constexpr int kAtOnce = std::min(partial_sums(kPixels * kVecs), kBlock / kStep);
  const std::ptrdiff_t panel = std::ptrdiff_t{a.to.in_blocks} * kBlock * kPanel;
  Sum sum[kAtOnce][kPixels][kVecs];
  for (int k = 0; k < kAtOnce; ++k) {
#pragma GCC unroll 16
    for (int p = 0; p < kPixels; ++p) {
      for (int v = 0; v < kVecs; ++v) {
        sum[k][p][v] = _mm512_setzero_si512();
      }
    }
  }
  std::int32_t left = a.to.in_blocks;
  do {
#pragma GCC unroll 1
    for (int lane = 0; lane < kBlock; lane += kStep * kAtOnce) {
      for (int k = 0; k < kAtOnce; ++k, w += kPairElems) {
        Sum weight[kVecs];
        for (int v = 0; v < kVecs; ++v) {
          weight[v] = _mm512_loadu_si512(w + v * panel);
        }
#pragma GCC unroll 16
        for (int p = 0; p < kPixels; ++p) {
          const Sum value = broadcast<kCount>(x + p * kBlock + lane + kStep * k);
          for (int v = 0; v < kVecs; ++v) {
            sum[k][p][v] = Multiply::add(sum[k][p][v], value, weight[v]);
          }
        }
      }
    }
    x += a.plane_elems;
  } while (--left > 0);
#pragma GCC unroll 16
  for (int p = 0; p < kPixels; ++p) {
    for (int v = 0; v < kVecs; ++v) {
      Sum total = sum[0][p][v];
      for (int k = 1; k < kAtOnce; ++k) {
        total = _mm512_add_epi32(total, sum[k][p][v]);
      }
      _mm512_storeu_si512(to.of[p * kVecs + v], total);
    }
  }
}

template <class Multiply, int kVecs, int kCount, int... kSizes>
Tiling<Run> tiles_of(std::int32_t pixels) {
  static constexpr SizedTile<Run> kTiles[] = {
      {kSizes, &sums_of<Multiply, kSizes, kVecs, kCount>}...};
  return tiling_of(kTiles, pixels);
}

// Panels from `first` on for all pixels.
template <class Finish>
void sweep(const QuantizedProduct& a, std::int32_t first, const Tiling<Run>& tiles) {
  const std::int16_t* w = a.pairs + std::ptrdiff_t{first} * a.to.in_blocks * kBlock * kPanel;
  const Finish finish(a, first);
  const auto run = [&](const SizedTile<Run>& tile, std::int32_t pixel, std::int32_t count) {
    PixelPointer<float> y(a.to.y, a.to.y_rows, first, pixel);
    auto residual =
        PixelPointer<const float>::optional(a.to.residual, a.to.residual_rows, first, pixel);
    for (; count > 0; --count, pixel += tile.pixels) {
      Sums sums;
      tile.run(a, a.values + std::ptrdiff_t{pixel} * kBlock, w, sums);
      residual.at != nullptr ? convert<Finish, true>(finish, sums, tile.pixels, y, residual)
                             : convert<Finish, false>(finish, sums, tile.pixels, y, residual);
    }
  };
  run(tiles.each, 0, tiles.count);
  if (tiles.last.run != nullptr) {
    run(tiles.last, a.to.pixels - tiles.last.pixels, 1);
  }
}

// `panels` 0: the last panel of 8.
template <class Multiply>
void sweep_panels(const QuantizedProduct& a, std::int32_t first, std::int32_t panels) {
  const std::int32_t pixels = a.to.pixels;
  switch (panels) {
    case 0:
      return sweep<HalfFinish>(a, first, tiles_of<Multiply, 1, 2, 1, 2, 4, 6, 9, 11, 13>(pixels));
    case 1:
      return sweep<Finish<1>>(a, first, tiles_of<Multiply, 1, 1, 1, 2, 4, 6, 9, 11, 13>(pixels));
    case 2:
      return sweep<Finish<2>>(
          a, first, tiles_of<Multiply, 2, 1, 1, 2, 4, 6, 7, 8, 9, 10, 11, 12, 13>(pixels));
    case 3:
      return sweep<Finish<3>>(a, first, tiles_of<Multiply, 3, 1, 9>(pixels));
    default:
      return sweep<Finish<4>>(a, first, tiles_of<Multiply, 4, 1, 1, 2, 3, 4, 5, 6>(pixels));
  }
}

template <class Multiply>
void multiply(const QuantizedProduct& a) {
  const std::int32_t panels = a.to.out_blocks / 2;
  const std::int32_t at_once = a.to.pixels <= 6 ? 4 : a.to.pixels == 9 ? 3 : 2;
  std::int32_t done = 0;
  for (std::int32_t count = at_once; count > 0; count = count > 2 ? 2 : count - 1) {
    for (; done + count <= panels; done += count) {
      sweep_panels<Multiply>(a, done, count);
    }
  }
  if (a.to.out_blocks % 2 != 0) {
    sweep_panels<Multiply>(a, done, 0);
  }
}

}  // namespace

void multiply_quantized(const QuantizedProduct& a) {
  a.is_int8() ? multiply<Int8>(a) : multiply<Int16>(a);
}

}  // namespace mien::kernels::avx512vnni
