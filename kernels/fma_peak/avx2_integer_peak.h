// fma_peak of tiers that multiply 16-bit integers with vectors of 256 bits.
#pragma once

#include "kernels/common/avx2.h"
#include "kernels/fma_peak/fma_peak.h"

namespace mien::kernels::avx2 {
namespace {

// Multiply::add(sum, value, weight) adds the products of two elements to each lane.
template <class Multiply>
void integer_peak(const FmaPeakArgs& a) {
  constexpr int kSums = 12;  // throughput 2 per cycle, latency 5 cycles, and spare
  __m256i sum[kSums];
  const __m256i ones = _mm256_set1_epi32(static_cast<int>(a.rounds % 512));
  for (int k = 0; k < kSums; ++k) {
    sum[k] = _mm256_add_epi32(ones, _mm256_set1_epi32(k));
  }
  const __m256i factor = _mm256_set1_epi16(3);
  // Unrolled by hand, because gcc 12 copies all sums in every iteration of a loop.
  constexpr int kUnrolled = 8;
  const std::int64_t turns = (a.rounds + kUnrolled - 1) / kUnrolled;
  for (std::int64_t i = 0; i < turns; ++i) {
#pragma GCC unroll 8
    for (int round = 0; round < kUnrolled; ++round) {
      for (__m256i& one : sum) {
        one = Multiply::add(one, one, factor);
      }
    }
  }
  __m256i total = _mm256_setzero_si256();
  for (const __m256i& one : sum) {
    total = _mm256_add_epi32(total, one);
  }
  // The sums wrap around; keep some bits that depend on all of them.
  total = _mm256_or_si256(_mm256_and_si256(total, _mm256_set1_epi32(62)), _mm256_set1_epi32(1));
  _mm256_storeu_ps(a.y, _mm256_cvtepi32_ps(total));
  *a.macs = turns * kUnrolled * kSums * 2 * kLanes;
}

}  // namespace
}  // namespace mien::kernels::avx2
