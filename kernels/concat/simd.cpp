// The concat kernel of all vector tiers.
#include <cstring>

#include "kernels/common/simd.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

// If the channels of a fill its last block, the blocks of b are copied as they are. Otherwise each
// further block takes lanes from two blocks of b, or from the last of a and the first of b.
void concat(const ConcatArgs& a) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.pixels} * kBlock;
  const std::int32_t whole = a.a_channels / kBlock, used = a.a_channels % kBlock;
  const std::int32_t b_blocks = blocks_of(a.b_channels);
  const auto bytes = [&](std::int32_t blocks) {
    return static_cast<std::size_t>(blocks * plane) * sizeof(float);
  };
  std::memcpy(a.y, a.a, bytes(whole));
  if (used == 0) {
    std::memcpy(a.y + whole * plane, a.b, bytes(b_blocks));
    return;
  }
  const LaneShift shift(kBlock - used);
  const std::int32_t blocks = blocks_of(a.a_channels + a.b_channels);
  for (std::int32_t block = whole; block < blocks; ++block) {
    const std::int32_t second = block - whole;  // the block of b in the upper lanes
    const float* low = second > 0 ? a.b + (second - 1) * plane : nullptr;
    const float* high = second < b_blocks ? a.b + second * plane : nullptr;
    for (std::ptrdiff_t p = 0; p < plane; p += kBlock) {
      BlockVec y = shift.apply(load_block_or_zero(low, p), load_block_or_zero(high, p));
      if (low == nullptr) {  // each lane is zero in one of the two
        y = either(y, load_block(a.a + whole * plane + p));
      }
      store_block(a.y + block * plane + p, y);
    }
  }
}

}  // namespace mien::kernels::MIEN_TIER
