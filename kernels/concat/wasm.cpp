// The wasm tier of concat.
#include <cstring>

#include "kernels/common/wasm_lanes.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

const float* block_at(const float* map, std::int32_t block, std::int32_t blocks,
                      std::ptrdiff_t plane) {
  return block >= 0 && block < blocks ? map + block * plane : nullptr;
}
const float* pixel_at(const float* block, std::ptrdiff_t p) {
  return block == nullptr ? nullptr : block + p;
}

}  // namespace

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
  const std::int32_t blocks = blocks_of(a.a_channels + a.b_channels);
  for (std::int32_t block = whole; block < blocks; ++block) {
    const std::int32_t second = block - whole;  // the block of b in the upper lanes
    const float* low = block_at(a.b, second - 1, b_blocks, plane);
    const float* high = block_at(a.b, second, b_blocks, plane);
    for (std::ptrdiff_t p = 0; p < plane; p += kBlock) {
      const TwoBlocks from_b(pixel_at(low, p), pixel_at(high, p));
      for (std::int32_t lane = 0; lane < kBlock; lane += kLanes) {
        Vec y = load(from_b.lanes + kBlock - used + lane);
        if (block == whole) {  // each lane is zero in one of the two
          y = wasm_v128_or(y, load(a.a + whole * plane + p + lane));
        }
        store(a.y + block * plane + p + lane, y);
      }
    }
  }
}

}  // namespace mien::kernels::wasm
