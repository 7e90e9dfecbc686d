// Register tiles of up to 12 pixels x 8 outputs. SMMLA multiplies 8 inputs of two pixels with those
// of two outputs: 32 products, twice those of SDOT.
#include "kernels/inverted_residual/dot_outputs.h"

namespace mien::kernels::neoni8mm {
namespace {

constexpr int kPairs = kBlock / 2;                     // of outputs
constexpr std::ptrdiff_t kPairElems = 16;              // 8 inputs of two pixels or outputs
constexpr std::ptrdiff_t kStep = kPairs * kPairElems;  // of weights

// The last pair of pixels may be half a pair, whose other half is zero.
template <int kPixels>
[[gnu::always_inline]] inline int8x16_t load_pixels(const std::int8_t* x, int pair) {
  const std::int8_t* at = x + pair * kPairElems;
  return 2 * pair + 1 < kPixels ? vld1q_s8(at) : vcombine_s8(vld1_s8(at), vdup_n_s8(0));
}

// Products of a pair of pixels: [pair of outputs][pixel][output].
[[gnu::always_inline]] inline Pair sums_of(const int32x4_t (&sums)[kPairs], int pixel) {
  int64x2_t pairs[kPairs];
  MIEN_UNROLLED for (int i = 0; i < kPairs; ++i) { pairs[i] = vreinterpretq_s64_s32(sums[i]); }
  const int64x2_t low =
      pixel == 0 ? vzip1q_s64(pairs[0], pairs[1]) : vzip2q_s64(pairs[0], pairs[1]);
  const int64x2_t high =
      pixel == 0 ? vzip1q_s64(pairs[2], pairs[3]) : vzip2q_s64(pairs[2], pairs[3]);
  return {vcvtq_f32_s32(vreinterpretq_s32_s64(low)), vcvtq_f32_s32(vreinterpretq_s32_s64(high))};
}

template <class To, int kPixels>
[[gnu::noinline]] void tile(const DotProduct& a, const std::int8_t* x, const std::int8_t* w,
                            const To& by, typename To::Place at) {
  constexpr int kPixelPairs = (kPixels + 1) / 2;
  int32x4_t sums[kPixelPairs][kPairs];
  MIEN_UNROLLED for (int i = 0; i < kPixelPairs * kPairs; ++i) {
    sums[i / kPairs][i % kPairs] = vdupq_n_s32(0);
  }
  const std::ptrdiff_t step = a.plane_elems;
  for (std::int32_t left = a.to.in_blocks; left > 0; --left, w += kStep, x += step) {
    int8x16_t weights[kPairs];
    MIEN_UNROLLED for (int i = 0; i < kPairs; ++i) { weights[i] = vld1q_s8(w + i * kPairElems); }
    MIEN_UNROLLED for (int p = 0; p < kPixelPairs; ++p) {
      const int8x16_t values = load_pixels<kPixels>(x, p);
      MIEN_UNROLLED for (int i = 0; i < kPairs; ++i) {
        sums[p][i] = vmmlaq_s32(sums[p][i], values, weights[i]);
      }
    }
  }
  const To to = by;
  MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) { to.store(sums_of(sums[p / 2], p % 2), at); }
}

template <class To, int... kSizes>
Tiling<Run<To>> tiling_of_sizes(std::int32_t pixels) {
  static constexpr SizedTile<Run<To>> kTiles[] = {{kSizes, &tile<To, kSizes>}...};
  return tiling_of(kTiles, pixels);
}

template <class To, class Rows>
void multiply(const DotProduct& a, const Rows& rows) {
  const std::ptrdiff_t block_bytes = std::ptrdiff_t{(a.to.in_blocks + 1) / 2} * 2 * kStep;
  const auto tiles = tiling_of_sizes<To, 1, 2, 4, 6, 8, 9, 12>(a.to.pixels);
  for (std::int32_t block = 0; block < a.to.out_blocks; ++block) {
    multiply_block<kBlock>(a, tiles, a.quads + block * block_bytes, To(a, rows, block));
  }
}

}  // namespace

void multiply_to_strip(const DotProduct& a, const StripRows& to) { multiply<ToStrip>(a, to); }
void multiply_to_map(const DotProduct& a, const MapRows& to) { multiply<ToMap>(a, to); }

}  // namespace mien::kernels::neoni8mm
