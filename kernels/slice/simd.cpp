// The slice kernel of all vector tiers.
#include "kernels/common/simd.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

// A block of y takes lanes from two blocks of x, unless the slice begins at a block boundary.
void slice(const SliceArgs& a) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kBlock;
  const LaneShift shift(a.first_channel % kBlock);
  const std::int32_t in_blocks = blocks_of(a.first_channel + a.channels);
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    const BlockMask mask = block_mask(block, a.channels);
    const std::int32_t from = a.first_channel / kBlock + block;
    const bool two = a.first_channel % kBlock != 0 && from + 1 < in_blocks;
    for (std::int32_t row = 0; row < a.h; ++row) {
      const float* low =
          a.x + from * plane + (std::ptrdiff_t{a.top + row} * a.in_w + a.left) * kBlock;
      const float* high = two ? low + plane : nullptr;
      for (std::ptrdiff_t p = 0; p < std::ptrdiff_t{a.w} * kBlock; p += kBlock, y += kBlock) {
        const BlockVec lanes = shift.apply(load_block(low + p), load_block_or_zero(high, p));
        store_block(y, only(mask, lanes));
      }
    }
  }
}

}  // namespace mien::kernels::MIEN_TIER
