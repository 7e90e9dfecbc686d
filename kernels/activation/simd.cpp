// The activate kernel of all vector tiers.
#include "kernels/common/simd.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void activate(const ActivateArgs& a) {
  const BlockActivator activator(a.activation, a.channels);
  const float* x = a.x;
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    float* first = y;
    const BlockMask mask = block_mask(block, a.channels);
    for (std::int32_t p = 0; p < a.pixels; ++p, x += kBlock, y += kBlock) {
      store_block(y, only(mask, activator.begin(load_block(x), block)));
    }
    activator.finish(first, a.pixels, block);
  }
}

}  // namespace mien::kernels::MIEN_TIER
