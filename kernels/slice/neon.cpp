// The neon and neon32 tiers of slice.
#include "kernels/common/neon_lanes.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

// A block of y takes lanes from two blocks of x, unless the slice begins at a block boundary.
void slice(const SliceArgs& a) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kBlock;
  const std::int32_t shift = a.first_channel % kBlock;
  const std::int32_t in_blocks = blocks_of(a.first_channel + a.channels);
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    const uint32x4_t low_mask = lane_mask(block * kBlock, a.channels);
    const uint32x4_t high_mask = lane_mask(block * kBlock + kLanes, a.channels);
    const std::int32_t from = a.first_channel / kBlock + block;
    const bool two = shift != 0 && from + 1 < in_blocks;
    for (std::int32_t row = 0; row < a.h; ++row) {
      const float* low =
          a.x + from * plane + (std::ptrdiff_t{a.top + row} * a.in_w + a.left) * kBlock;
      const float* high = two ? low + plane : nullptr;
      for (std::ptrdiff_t p = 0; p < std::ptrdiff_t{a.w} * kBlock; p += kBlock, y += kBlock) {
        const Pair lanes = shifted(load_pair(low + p), load_pair_or_zero(high, p), shift);
        store_pair(y, {only(low_mask, lanes.low), only(high_mask, lanes.high)});
      }
    }
  }
}

}  // namespace mien::kernels::MIEN_TIER
