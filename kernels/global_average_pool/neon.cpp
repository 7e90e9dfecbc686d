// The neon and neon32 tiers of global_average_pool.
#include "kernels/common/neon.h"
#include "kernels/families.h"
#include "kernels/global_average_pool/parts.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Four sums per vector hide the latency of additions.
void sum_of_part(const float* x, std::int32_t pixels, float (&part)[8]) {
  constexpr int kSums = 4;
  Vec low[kSums], high[kSums];
  MIEN_UNROLLED for (int i = 0; i < kSums; ++i) { low[i] = high[i] = splat(0.0f); }
  std::int32_t p = 0;
  for (; p + kSums <= pixels; p += kSums, x += kSums * kBlock) {
    MIEN_UNROLLED for (int i = 0; i < kSums; ++i) {
      const Pair value = load_pair(x + i * kBlock);
      low[i] = vaddq_f32(low[i], value.low);
      high[i] = vaddq_f32(high[i], value.high);
    }
  }
  for (; p < pixels; ++p, x += kBlock) {
    const Pair value = load_pair(x);
    low[0] = vaddq_f32(low[0], value.low);
    high[0] = vaddq_f32(high[0], value.high);
  }
  const auto total = [](const Vec(&sums)[kSums]) {
    return vaddq_f32(vaddq_f32(sums[0], sums[1]), vaddq_f32(sums[2], sums[3]));
  };
  store_pair(part, {total(low), total(high)});
}

}  // namespace

void global_average_pool(const GlobalAveragePoolArgs& a) { mean_by_parts(a, sum_of_part); }

}  // namespace mien::kernels::MIEN_TIER
