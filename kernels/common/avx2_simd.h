// The vectors of kernels/common/simd.h on AVX2, where a block of 8 channels is one vector.
#pragma once

#include "kernels/common/avx2.h"
#include "kernels/common/unrolled.h"

namespace mien::kernels::avx2 {

constexpr std::int32_t kBlock = kLanes;

namespace {

using Mask = Vec;
using BlockVec = Vec;
using BlockMask = Vec;

inline Vec splat(float x) { return _mm256_set1_ps(x); }
inline Vec load(const float* at) { return _mm256_loadu_ps(at); }
inline void store(float* at, Vec x) { _mm256_storeu_ps(at, x); }

inline Vec add(Vec a, Vec b) { return _mm256_add_ps(a, b); }
inline Vec subtract(Vec a, Vec b) { return _mm256_sub_ps(a, b); }
inline Vec divide(Vec a, Vec b) { return _mm256_div_ps(a, b); }
inline Vec max(Vec a, Vec b) { return _mm256_max_ps(a, b); }

inline Vec only(Mask mask, Vec x) { return _mm256_and_ps(x, mask); }
inline Vec choose(Mask mask, Vec x, Vec other) { return _mm256_blendv_ps(other, x, mask); }

inline Vec sum_of_lanes(Vec x) { return splat(across(x, add)); }
inline Vec largest_lane(Vec x) { return splat(across(x, max)); }

inline BlockVec splat_block(float x) { return splat(x); }
inline BlockVec load_block(const float* at) { return load(at); }
inline BlockVec load_block_or_zero(const float* map, std::ptrdiff_t at) {
  return map == nullptr ? _mm256_setzero_ps() : load(map + at);
}
inline void store_block(float* at, BlockVec x) { store(at, x); }
inline BlockMask block_mask(std::int32_t block, std::int32_t channels) {
  return lane_mask(block * kBlock, channels);
}
// Bitwise or: in each lane the operand that is not zero.
inline BlockVec either(BlockVec a, BlockVec b) { return _mm256_or_ps(a, b); }

class LaneShift {
 public:
  // `lanes` in 0..7.
  explicit LaneShift(std::int32_t lanes) {
    const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    const __m256i from = _mm256_add_epi32(lane, _mm256_set1_epi32(lanes));
    order_ = _mm256_and_si256(from, _mm256_set1_epi32(7));
    from_high_ = _mm256_castsi256_ps(_mm256_cmpgt_epi32(from, _mm256_set1_epi32(7)));
  }

  // Lanes `lanes` .. `lanes` + 7 of the concatenation of `low` and `high`.
  [[nodiscard]] BlockVec apply(BlockVec low, BlockVec high) const {
    return _mm256_blendv_ps(_mm256_permutevar8x32_ps(low, order_),
                            _mm256_permutevar8x32_ps(high, order_), from_high_);
  }

 private:
  __m256i order_;
  Vec from_high_;
};

class BlockActivator {
 public:
  BlockActivator(const ActivationSpec& activation, std::int32_t channels)
      : activation_(activation), channels_(channels) {}

  [[nodiscard]] BlockVec begin(BlockVec x, std::int32_t block) const {
    return activated(x, activation_, block, channels_);
  }
  void finish(float* /*y*/, std::int32_t /*pixels*/, std::int32_t /*block*/) const {}

 private:
  ActivationSpec activation_;  // a copy: stores of vectors might change the original
  std::int32_t channels_;
};

}  // namespace
}  // namespace mien::kernels::avx2
