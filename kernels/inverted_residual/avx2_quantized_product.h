// Products of integers with vectors of 256 bits, for the tiers avx2int16 and avxvnni: register
// tiles of up to 6 pixels x 16 output channels. Each lane multiplies 4 bytes at once: two elements
// of the sum of 16 bits, or four of 8. A last panel of 8 multiplies 8 bytes, 4 in the even lanes
// and 4 in the odd.
//
// A tile only leaves integer sums; one loop converts the sums of all tiles, because that needs less
// code than converting them in each.
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
inline constexpr int kMaxPixels = 6;
inline constexpr int kStepElems = 2 * kPanel;  // weights of 16 bits of one step

// Aligned, because stores that cross cache lines are slow.
struct alignas(64) Sums {
  std::int32_t of[kMaxPixels][kPanel];
};

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

inline __m256i load_sums(const std::int32_t* at) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(at));
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
      QuantizedTiles(a, panel).template sweep<1>();
    }
    if (a.to.out_blocks % 2 != 0) {
      QuantizedTiles(a, panels).template sweep<2>();
    }
  }

 private:
  using Run = void (*)(const QuantizedProduct&, const std::int16_t* x, const std::int16_t* w,
                       Sums&);

  QuantizedTiles(const QuantizedProduct& product, std::int32_t panel)
      : a_(product),
        panel_(panel),
        weights_(product.pairs + std::ptrdiff_t{panel} * product.to.in_blocks * kLanes * kPanel) {}

  template <int kCount>
  void sweep() const {
    const Tiling<Run> tiles = tiles_of<kCount, 1, 2, 3, 4, 5, 6>(a_.to.pixels);
    const std::int32_t after = tiles.each.pixels * tiles.count;
    run<kCount>(tiles.each, 0, after);
    if (tiles.last.run != nullptr) {
      run<kCount>(tiles.last, a_.to.pixels - tiles.last.pixels, a_.to.pixels);
    }
  }

  template <int kCount, int... kSizes>
  static Tiling<Run> tiles_of(std::int32_t pixels) {
    static constexpr SizedTile<Run> kTiles[] = {{kSizes, &sums_of<kSizes, kCount>}...};
    return tiling_of(kTiles, pixels);
  }

  // Computes pixels [first, end) in tiles of one size.
  template <int kCount>
  void run(const SizedTile<Run>& tile, std::int32_t first, std::int32_t end) const {
    const std::ptrdiff_t channel = std::ptrdiff_t{panel_} * kPanel;
    const Finish blocks[] = {Finish(a_, channel),
                             Finish(a_, kCount == 1 ? channel + kLanes : channel)};
    PixelPointer<float> y(a_.to.y, a_.to.y_rows, panel_, first);
    auto residual =
        PixelPointer<const float>::optional(a_.to.residual, a_.to.residual_rows, panel_, first);
    for (std::int32_t pixel = first; pixel < end; pixel += tile.pixels) {
      Sums sums;
      tile.run(a_, a_.values + std::ptrdiff_t{pixel} * kLanes, weights_, sums);
      residual.at != nullptr ? convert<kCount, true>(blocks, sums, tile.pixels, y, residual)
                             : convert<kCount, false>(blocks, sums, tile.pixels, y, residual);
    }
  }

  template <int kCount, bool kResidual>
  static void convert(const Finish* blocks, const Sums& sums, std::int32_t pixels,
                      PixelPointer<float>& y, PixelPointer<const float>& residual) {
    PixelPointer<float> to = y;
    PixelPointer<const float> r = residual;
    const Finish low = blocks[0], high = blocks[1];
    const auto store = [&](std::ptrdiff_t to_half, std::ptrdiff_t r_half, Vec value) {
      if constexpr (kResidual) {
        value = _mm256_add_ps(value, _mm256_loadu_ps(r.at + r_half));
      }
      _mm256_storeu_ps(to.at + to_half, value);
    };
    for (std::int32_t p = 0; p < pixels; ++p, to.advance()) {
      const __m256i first = load_sums(sums.of[p]), second = load_sums(sums.of[p] + kLanes);
      if constexpr (kCount == 1) {
        store(0, 0, low.of(first));
        store(to.half, r.half, high.of(second));
      } else {
        const __m256i sum = _mm256_hadd_epi32(first, second);
        store(0, 0, low.of(_mm256_permute4x64_epi64(sum, 0xD8)));
      }
      if constexpr (kResidual) {
        r.advance();
      }
    }
    y = to;
    residual = r;
  }

  // Multiplies 4 kCount bytes at once.
  template <int kPixels, int kCount>
  static void sums_of(const QuantizedProduct& a, const std::int16_t* x, const std::int16_t* w,
                      Sums& to) {
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
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to.of[p] + v * kLanes), total);
      }
    }
  }

  const QuantizedProduct& a_;
  std::int32_t panel_;
  const std::int16_t* weights_;
};

}  // namespace
}  // namespace mien::kernels::avx2
