// fma_peak of tiers that multiply 16-bit integers with vectors of 256 bits.
#pragma once

#include "kernels/common/avx2.h"
#include "kernels/fma_peak/integer_peak.h"

namespace mien::kernels::avx2 {
namespace {

// Multiply::add(sum, value, weight) adds the products of two elements to each lane.
template <class Multiply>
struct IntegerVector {
  using Sum = __m256i;
  static constexpr int kSums = 12;
  static constexpr int kProducts = 2 * kLanes;

  static Sum all(int value) { return _mm256_set1_epi32(value); }
  static Sum add(Sum a, Sum b) { return _mm256_add_epi32(a, b); }
  static Sum bit_and(Sum a, Sum b) { return _mm256_and_si256(a, b); }
  static Sum bit_or(Sum a, Sum b) { return _mm256_or_si256(a, b); }
  static Sum multiply_add(Sum sum, Sum value, Sum weight) {
    return Multiply::add(sum, value, weight);
  }
  static void store(Sum sum, float* y) { _mm256_storeu_ps(y, _mm256_cvtepi32_ps(sum)); }
};

}  // namespace
}  // namespace mien::kernels::avx2
