// The wasm tier of slice.
#include "kernels/common/wasm_lanes.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {

// A block of y takes lanes from two blocks of x, unless the slice begins at a block boundary.
void slice(const SliceArgs& a) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kBlock;
  const std::int32_t shift = a.first_channel % kBlock;
  const std::int32_t in_blocks = blocks_of(a.first_channel + a.channels);
  float* y = a.y;
  for (std::int32_t channel = 0; channel < a.channels; channel += kBlock) {
    const Vec masks[] = {lane_mask(channel, a.channels), lane_mask(channel + kLanes, a.channels)};
    const std::int32_t from = (a.first_channel + channel) / kBlock;
    const bool two = shift != 0 && from + 1 < in_blocks;
    for (std::int32_t row = 0; row < a.h; ++row) {
      const float* x =
          a.x + from * plane + (std::ptrdiff_t{a.top + row} * a.in_w + a.left) * kBlock;
      for (std::int32_t p = 0; p < a.w; ++p, x += kBlock, y += kBlock) {
        const TwoBlocks blocks(x, two ? x + plane : nullptr);
        store(y, only(masks[0], load(blocks.lanes + shift)));
        store(y + kLanes, only(masks[1], load(blocks.lanes + shift + kLanes)));
      }
    }
  }
}

}  // namespace mien::kernels::wasm
