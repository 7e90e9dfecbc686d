// The wasm tier of max_pool.
#include <algorithm>
#include <limits>

#include "kernels/common/wasm.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

struct Window {
  std::int32_t top, bottom, left, right;  // part inside the map: [top, bottom) x [left, right)
};

Window window_of(const MaxPoolArgs& a, std::int32_t oy, std::int32_t ox) {
  const std::int32_t top = oy * a.stride_h - a.pad_top, left = ox * a.stride_w - a.pad_left;
  return {std::max(top, 0), std::min(top + a.kernel_h, a.in_h), std::max(left, 0),
          std::min(left + a.kernel_w, a.in_w)};
}

// Maximum of four channels, from x on.
Vec window_max(const MaxPoolArgs& a, const float* x, const Window& window) {
  Vec largest = splat(-std::numeric_limits<float>::infinity());
  for (std::int32_t iy = window.top; iy < window.bottom; ++iy) {
    for (std::int32_t ix = window.left; ix < window.right; ++ix) {
      const Vec here = load(x + (std::ptrdiff_t{iy} * a.in_w + ix) * kBlock);
      largest = at_least(largest, here);
    }
  }
  return largest;
}

}  // namespace

void max_pool(const MaxPoolArgs& a) {
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    const float* x = a.x + std::ptrdiff_t{block} * a.in_h * a.in_w * kBlock;
    for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
      for (std::int32_t ox = 0; ox < a.out_w; ++ox, y += kBlock) {
        const Window window = window_of(a, oy, ox);
        for (std::int32_t lane = 0; lane < kBlock; lane += kLanes) {
          const Vec mask = lane_mask(block * kBlock + lane, a.channels);
          store(y + lane, only(mask, window_max(a, x + lane, window)));
        }
      }
    }
  }
}

}  // namespace mien::kernels::wasm
