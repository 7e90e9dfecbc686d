// The neonfp16 tier of fma_peak.
#include "kernels/common/neon_half.h"
#include "kernels/families.h"

namespace mien::kernels::neonfp16 {

// Like neon.cpp, with vectors of 8 lanes.
void fma_peak(const FmaPeakArgs& a) {
  constexpr int kSums = 24;
  HalfVec sum[kSums];
  // Derived from the arguments: with constants, fp16 sums soon converge, which a compiler may
  // notice.
  const auto first = static_cast<float>(a.rounds % 512) * 1e-3f;
  MIEN_UNROLLED for (int k = 0; k < kSums; ++k) {
    sum[k] = splat_halves(first + 0.1f * static_cast<float>(k));
  }
  const HalfVec factors = splat_halves(0.001f), terms = splat_halves(0.999f);
  for (std::int64_t i = 0; i < a.rounds; ++i) {
    MIEN_UNROLLED for (int k = 0; k < kSums; ++k) { sum[k] = fma_lane<1>(sum[k], factors, terms); }
  }
  HalfVec total = splat_halves(0.0f);
  MIEN_UNROLLED for (int k = 0; k < kSums; ++k) { total = vaddq_f16(total, sum[k]); }
  store_pair(a.y, widened(total));
  *a.macs = a.rounds * kSums * kHalves;
}

}  // namespace mien::kernels::neonfp16
