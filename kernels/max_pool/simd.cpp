// The max_pool kernel of all vector tiers.
#include <algorithm>
#include <limits>

#include "kernels/common/simd.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

struct Range {
  std::int32_t first, last;  // rows or columns [first, last) of a window inside the map
};

Range window(std::int32_t output, std::int32_t stride, std::int32_t pad, std::int32_t kernel,
             std::int32_t size) {
  const std::int32_t origin = output * stride - pad;
  return {std::max(origin, 0), std::min(origin + kernel, size)};
}

BlockVec largest(const float* x, std::int32_t in_w, const Range& ys, const Range& xs) {
  BlockVec best = splat_block(-std::numeric_limits<float>::infinity());
  for (std::int32_t iy = ys.first; iy < ys.last; ++iy) {
    const float* row = x + std::ptrdiff_t{iy} * in_w * kBlock;
    for (std::int32_t ix = xs.first; ix < xs.last; ++ix) {
      best = max(best, load_block(row + ix * kBlock));
    }
  }
  return best;
}

}  // namespace

void max_pool(const MaxPoolArgs& a) {
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    const float* x = a.x + std::ptrdiff_t{block} * a.in_h * a.in_w * kBlock;
    const BlockMask mask = block_mask(block, a.channels);
    for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
      const Range ys = window(oy, a.stride_h, a.pad_top, a.kernel_h, a.in_h);
      for (std::int32_t ox = 0; ox < a.out_w; ++ox, y += kBlock) {
        const Range xs = window(ox, a.stride_w, a.pad_left, a.kernel_w, a.in_w);
        store_block(y, only(mask, largest(x, a.in_w, ys, xs)));
      }
    }
  }
}

}  // namespace mien::kernels::MIEN_TIER
