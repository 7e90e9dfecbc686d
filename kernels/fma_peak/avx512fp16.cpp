// The avx512fp16 tier of fma_peak.
#include "kernels/common/avx512.h"
#include "kernels/families.h"

namespace mien::kernels::avx512fp16 {

void fma_peak(const FmaPeakArgs& a) {
  constexpr int kSums = 16;  // throughput 2 per cycle, latency 4 cycles, and spare
  __m512h sum[kSums];
  // Derived from the arguments: with constants, fp16 sums soon converge, which a compiler may
  // notice.
  const __m512i ones = _mm512_set1_epi16(static_cast<short>(0x3C00 + a.rounds % 512));
  for (int k = 0; k < kSums; ++k) {
    sum[k] = _mm512_castsi512_ph(_mm512_add_epi16(ones, _mm512_set1_epi16(static_cast<short>(k))));
  }
  const __m512h factor = _mm512_set1_ph(static_cast<_Float16>(0.999f));
  const __m512h term = _mm512_set1_ph(static_cast<_Float16>(0.001f));
  for (std::int64_t i = 0; i < a.rounds; ++i) {
    for (__m512h& one : sum) {
      one = _mm512_fmadd_ph(one, factor, term);
    }
  }
  __m512h total = _mm512_setzero_ph();
  for (const __m512h& one : sum) {
    total = _mm512_add_ph(total, one);
  }
  _mm256_storeu_ps(a.y, _mm256_cvtph_ps(_mm512_castsi512_si128(_mm512_castph_si512(total))));
  *a.macs = a.rounds * kSums * 32;
}

}  // namespace mien::kernels::avx512fp16
