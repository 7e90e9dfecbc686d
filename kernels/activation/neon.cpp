// The neon and neon32 tiers of activate.
#include "kernels/common/neon_activation.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void activate(const ActivateArgs& a) {
  const Activator activator(a.activation, a.channels);
  const float* x = a.x;
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    float* first = y;
    const uint32x4_t low = lane_mask(block * kBlock, a.channels);
    const uint32x4_t high = lane_mask(block * kBlock + kLanes, a.channels);
    for (std::int32_t p = 0; p < a.pixels; ++p, x += kBlock, y += kBlock) {
      const Pair value = load_pair(x);
      store_pair(
          y, {only(low, activator.clamped(value.low)), only(high, activator.clamped(value.high))});
    }
    if (activator.curves()) {
      activator.curve_block(first, a.pixels, block);
    }
  }
}

}  // namespace mien::kernels::MIEN_TIER
