// The avx2 tier of fma_peak.
#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {

void fma_peak(const FmaPeakArgs& a) {
  constexpr int kSums = 12;  // throughput 2 per cycle, latency up to 5 cycles, and spare
  Vec sum[kSums];
  for (int k = 0; k < kSums; ++k) {
    sum[k] = _mm256_set1_ps(static_cast<float>(k));
  }
  const Vec factor = _mm256_set1_ps(0.999f), term = _mm256_set1_ps(0.001f);
  for (std::int64_t i = 0; i < a.rounds; ++i) {
    for (Vec& one : sum) {
      one = _mm256_fmadd_ps(one, factor, term);
    }
  }
  Vec total = _mm256_setzero_ps();
  for (const Vec& one : sum) {
    total = _mm256_add_ps(total, one);
  }
  _mm256_storeu_ps(a.y, total);
  *a.macs = a.rounds * kSums * kLanes;
}

}  // namespace mien::kernels::avx2
