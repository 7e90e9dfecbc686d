#include "kernels/common/neon.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

// Four sums of each vector hide the latency of additions, and err less on large maps than one
// would.
void global_average_pool(const GlobalAveragePoolArgs& a) {
  constexpr int kSums = 4;
  const Vec scale = splat(1.0f / static_cast<float>(a.pixels));
  const float* x = a.x;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    Vec low[kSums], high[kSums];
    MIEN_UNROLLED for (int i = 0; i < kSums; ++i) { low[i] = high[i] = splat(0.0f); }
    std::int32_t p = 0;
    for (; p + kSums <= a.pixels; p += kSums, x += kSums * kBlock) {
      MIEN_UNROLLED for (int i = 0; i < kSums; ++i) {
        const Pair value = load_pair(x + i * kBlock);
        low[i] = vaddq_f32(low[i], value.low);
        high[i] = vaddq_f32(high[i], value.high);
      }
    }
    for (; p < a.pixels; ++p, x += kBlock) {
      const Pair value = load_pair(x);
      low[0] = vaddq_f32(low[0], value.low);
      high[0] = vaddq_f32(high[0], value.high);
    }
    const auto mean = [&](const Vec(&sums)[kSums]) {
      return vmulq_f32(vaddq_f32(vaddq_f32(sums[0], sums[1]), vaddq_f32(sums[2], sums[3])), scale);
    };
    store_pair(a.y + std::ptrdiff_t{block} * kBlock, {mean(low), mean(high)});
  }
}

}  // namespace mien::kernels::MIEN_TIER
