// The avx512 tier of fma_peak.
#include "kernels/common/avx512.h"
#include "kernels/families.h"

namespace mien::kernels::avx512 {

void fma_peak(const FmaPeakArgs& a) {
  constexpr int kSums = 16;  // throughput 2 per cycle, latency 4 cycles, and spare
  Vec sum[kSums];
  for (int k = 0; k < kSums; ++k) {
    sum[k] = _mm512_set1_ps(static_cast<float>(k % 8));
  }
  const Vec factor = _mm512_set1_ps(0.999f), term = _mm512_set1_ps(0.001f);
  for (std::int64_t i = 0; i < a.rounds; ++i) {
    for (Vec& one : sum) {
      one = _mm512_fmadd_ps(one, factor, term);
    }
  }
  Vec total = _mm512_setzero_ps();
  for (const Vec& one : sum) {
    total = _mm512_add_ps(total, one);
  }
  _mm256_storeu_ps(a.y, _mm512_castps512_ps256(total));
  *a.macs = a.rounds * kSums * kPanel;
}

}  // namespace mien::kernels::avx512
