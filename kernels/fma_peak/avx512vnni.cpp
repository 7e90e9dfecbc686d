// The avx512vnni tier of fma_peak.
#include "kernels/common/avx512.h"
#include "kernels/families.h"

namespace mien::kernels::avx512vnni {

void fma_peak(const FmaPeakArgs& a) {
  constexpr int kSums = 16;  // throughput 2 per cycle, latency 5 cycles, and spare
  __m512i sum[kSums];
  const __m512i ones = _mm512_set1_epi32(static_cast<int>(a.rounds % 512));
  for (int k = 0; k < kSums; ++k) {
    sum[k] = _mm512_add_epi32(ones, _mm512_set1_epi32(k));
  }
  const __m512i factor = _mm512_set1_epi16(3);
  // Unrolled by hand, because gcc 12 copies all sums in every iteration of a loop.
  constexpr int kUnrolled = 8;
  const std::int64_t turns = (a.rounds + kUnrolled - 1) / kUnrolled;
  for (std::int64_t i = 0; i < turns; ++i) {
#pragma GCC unroll 8
    for (int round = 0; round < kUnrolled; ++round) {
      for (__m512i& one : sum) {
        one = _mm512_dpwssd_epi32(one, ones, factor);
      }
    }
  }
  __m512i total = _mm512_setzero_si512();
  for (const __m512i& one : sum) {
    total = _mm512_add_epi32(total, one);
  }
  // The sums wrap around; keep some bits that depend on all of them.
  total = _mm512_or_si512(_mm512_and_si512(total, _mm512_set1_epi32(62)), _mm512_set1_epi32(1));
  _mm256_storeu_ps(a.y, _mm256_cvtepi32_ps(_mm512_castsi512_si256(total)));
  *a.macs = turns * kUnrolled * kSums * 2 * avx512::kPanel;
}

}  // namespace mien::kernels::avx512vnni
