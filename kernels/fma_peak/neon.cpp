// The neon and neon32 tiers of fma_peak.
#include "kernels/common/neon.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

// Products by lane, as in the convolutions. Sums grow by a thousandth in each round.
void fma_peak(const FmaPeakArgs& a) {
#ifdef MIEN_NEON64
  constexpr int kSums = 24;  // throughput 4 per cycle, latency up to 5 cycles, and spare
#else
  constexpr int kSums = 12;
#endif
  Vec sum[kSums];
  MIEN_UNROLLED for (int k = 0; k < kSums; ++k) { sum[k] = splat(0.1f * static_cast<float>(k)); }
  const Vec factors = splat(0.001f), terms = splat(0.999f);
  for (std::int64_t i = 0; i < a.rounds; ++i) {
    MIEN_UNROLLED for (int k = 0; k < kSums; ++k) { sum[k] = fma_lane<1>(sum[k], factors, terms); }
  }
  Vec total = splat(0.0f);
  MIEN_UNROLLED for (int k = 0; k < kSums; ++k) { total = vaddq_f32(total, sum[k]); }
  store_pair(a.y, {total, total});
  *a.macs = a.rounds * kSums * kLanes;
}

}  // namespace mien::kernels::MIEN_TIER
