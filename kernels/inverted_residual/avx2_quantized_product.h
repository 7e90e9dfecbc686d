// Products of integers with vectors of 256 bits, for the tiers avx2int16 and avxvnni: register
// tiles of up to 6 pixels x 16 output channels. Each lane multiplies 4 bytes at once: two elements
// of the sum of 16 bits, or four of 8. A last panel of 8 multiplies 8 bytes, 4 in the even lanes
// and 4 in the odd.
#pragma once

#include <algorithm>

#include "kernels/common/avx2.h"
#include "kernels/common/pixel_pointer.h"
#include "kernels/common/product_sums.h"
#include "kernels/common/sized_tile.h"
#include "kernels/inverted_residual/quantized_product.h"

namespace mien::kernels::avx2 {
namespace {

inline constexpr int kVecs = kPanel / kLanes;
inline constexpr int kStepElems = 2 * kPanel;  // weights of 16 bits of one step

// Broadcasts 4 bytes to every lane, or 8 bytes to every two lanes.
template <int kCount>
__m256i broadcast_pairs(const std::int16_t* x) {
  if constexpr (kCount == 1) {
    int pair;
    __builtin_memcpy(&pair, x, sizeof pair);
    return _mm256_set1_epi32(pair);
  } else {
    long long pairs;
    __builtin_memcpy(&pairs, x, sizeof pairs);
    return _mm256_set1_epi64x(pairs);
  }
}

// Converts the sums of one block of 8 outputs to results.
struct Finish {
  Vec low, high, scale, bias;

  Finish(const QuantizedProduct& a, std::ptrdiff_t channel)
      : low(_mm256_set1_ps(a.to.low)),
        high(_mm256_set1_ps(a.to.high)),
        scale(_mm256_mul_ps(_mm256_loadu_ps(a.scales + channel), _mm256_set1_ps(a.x_scale))),
        bias(load_half(a.to.bias + channel)) {
    if (a.is_int8()) {
      const Vec shift = _mm256_mul_ps(_mm256_loadu_ps(a.sums + channel), _mm256_set1_ps(a.x_shift));
      bias = _mm256_fnmadd_ps(shift, scale, bias);
    }
  }
  [[nodiscard]] Vec of(__m256i sum) const {
    const Vec y = _mm256_fmadd_ps(_mm256_cvtepi32_ps(sum), scale, bias);
    return _mm256_min_ps(high, _mm256_max_ps(low, y));
  }
};

// Multiply::add(sum, value, weight) adds the products of 4 bytes to each lane.
template <class Multiply>
class QuantizedTiles {
 public:
  static void multiply(const QuantizedProduct& a) {
    const std::int32_t panels = a.to.out_blocks / 2;
    for (std::int32_t panel = 0; panel < panels; ++panel) {
      QuantizedTiles(a, panel, 2).template sweep<1>();
    }
    if (a.to.out_blocks % 2 != 0) {
      QuantizedTiles(a, panels, 1).template sweep<2>();
    }
  }

 private:
  using Run = void (*)(const QuantizedTiles&, std::int32_t first, std::int32_t end);
  template <int kPixels>
  using Sums = __m256i[kPixels][kVecs];

  QuantizedTiles(const QuantizedProduct& product, std::int32_t panel, std::int32_t blocks)
      : a_(product),
        panel_(panel),
        weights_(product.pairs + std::ptrdiff_t{panel} * product.to.in_blocks * kLanes * kPanel),
        lower_(product, std::ptrdiff_t{panel} * kPanel),
        upper_(product, std::ptrdiff_t{panel} * kPanel + (blocks - 1) * kLanes) {}

  template <int kCount>
  void sweep() const {
    const Tiling<Run> tiles = tiles_of<kCount, 1, 2, 3, 4, 5, 6>(a_.to.pixels);
    tiles.each.run(*this, 0, tiles.each.pixels * tiles.count);
    if (tiles.last.run != nullptr) {
      tiles.last.run(*this, a_.to.pixels - tiles.last.pixels, a_.to.pixels);
    }
  }

  template <int kCount, int... kSizes>
  static Tiling<Run> tiles_of(std::int32_t pixels) {
    static constexpr SizedTile<Run> kTiles[] = {{kSizes, &run<kSizes, kCount>}...};
    return tiling_of(kTiles, pixels);
  }

  // Computes pixels [first, end) in tiles of one size.
  template <int kPixels, int kCount>
  static void run(const QuantizedTiles& tiles, std::int32_t first, std::int32_t end) {
    const QuantizedProduct& a = tiles.a_;
    const Finish lower = tiles.lower_, upper = tiles.upper_;  // in registers, unlike members
    PixelPointer<float> y(a.to.y, a.to.y_rows, tiles.panel_, first);
    auto residual =
        PixelPointer<const float>::optional(a.to.residual, a.to.residual_rows, tiles.panel_, first);
    for (std::int32_t pixel = first; pixel < end; pixel += kPixels) {
      Sums<kPixels> sums;
      sums_of<kPixels, kCount>(a, a.values + std::ptrdiff_t{pixel} * kLanes, tiles.weights_, sums);
      residual.at != nullptr ? convert<kPixels, kCount, true>(lower, upper, sums, y, residual)
                             : convert<kPixels, kCount, false>(lower, upper, sums, y, residual);
    }
  }

  // Converts the sums of a tile. Inlined, so that they stay in registers.
  template <int kPixels, int kCount, bool kResidual>
  [[gnu::always_inline]] static void convert(const Finish& lower, const Finish& upper,
                                             const Sums<kPixels>& sums, PixelPointer<float>& y,
                                             PixelPointer<const float>& residual) {
    const auto store = [&](std::ptrdiff_t to_half, std::ptrdiff_t r_half, Vec value) {
      if constexpr (kResidual) {
        value = _mm256_add_ps(value, _mm256_loadu_ps(residual.at + r_half));
      }
      _mm256_storeu_ps(y.at + to_half, value);
    };
#pragma GCC unroll 6
    for (int p = 0; p < kPixels; ++p, y.advance()) {
      if constexpr (kCount == 1) {
        store(0, 0, lower.of(sums[p][0]));
        store(y.half, residual.half, upper.of(sums[p][1]));
      } else {
        const __m256i sum = _mm256_hadd_epi32(sums[p][0], sums[p][1]);
        store(0, 0, lower.of(_mm256_permute4x64_epi64(sum, 0xD8)));
      }
      if constexpr (kResidual) {
        residual.advance();
      }
    }
  }

  // Multiplies 4 kCount bytes at once.
  template <int kPixels, int kCount>
  static void sums_of(const QuantizedProduct& a, const std::int16_t* x, const std::int16_t* w,
                      Sums<kPixels>& to) {
    constexpr int kStep = 2 * kCount;
    constexpr int kAtOnce = std::min(partial_sums(kPixels * kVecs), kLanes / kStep);
    __m256i sum[kAtOnce][kPixels][kVecs];
    for (int k = 0; k < kAtOnce; ++k) {
#pragma GCC unroll 6
      for (int p = 0; p < kPixels; ++p) {
        for (int v = 0; v < kVecs; ++v) {
          sum[k][p][v] = _mm256_setzero_si256();
        }
      }
    }
    std::int32_t left = a.to.in_blocks;
    do {
#pragma GCC unroll 1
      for (int lane = 0; lane < kLanes; lane += kStep * kAtOnce) {
        for (int k = 0; k < kAtOnce; ++k, w += kStepElems) {
          __m256i weight[kVecs];
          for (int v = 0; v < kVecs; ++v) {
            weight[v] = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(w + v * kPanel));
          }
#pragma GCC unroll 6
          for (int p = 0; p < kPixels; ++p) {
            const __m256i value = broadcast_pairs<kCount>(x + p * kLanes + lane + kStep * k);
            for (int v = 0; v < kVecs; ++v) {
              sum[k][p][v] = Multiply::add(sum[k][p][v], value, weight[v]);
            }
          }
        }
      }
      x += a.plane_elems;
    } while (--left > 0);
#pragma GCC unroll 6
    for (int p = 0; p < kPixels; ++p) {
      for (int v = 0; v < kVecs; ++v) {
        __m256i total = sum[0][p][v];
        for (int k = 1; k < kAtOnce; ++k) {
          total = _mm256_add_epi32(total, sum[k][p][v]);
        }
        to[p][v] = total;
      }
    }
  }

  const QuantizedProduct& a_;
  std::int32_t panel_;
  const std::int16_t* weights_;
  Finish lower_, upper_;  // of the blocks of the panel, which may be one
};

}  // namespace
}  // namespace mien::kernels::avx2
