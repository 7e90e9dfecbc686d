// Loads eight consecutive channels that span two blocks.
#pragma once

#include "kernels/common/avx2.h"

namespace mien::kernels::avx2 {
namespace {

inline Vec load_or_zero(const float* map, std::ptrdiff_t at) {
  return map == nullptr ? _mm256_setzero_ps() : _mm256_loadu_ps(map + at);
}

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
  [[nodiscard]] Vec apply(Vec low, Vec high) const {
    return _mm256_blendv_ps(_mm256_permutevar8x32_ps(low, order_),
                            _mm256_permutevar8x32_ps(high, order_), from_high_);
  }

 private:
  __m256i order_;
  Vec from_high_;
};

}  // namespace
}  // namespace mien::kernels::avx2
