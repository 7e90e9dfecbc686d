// The reference kernel of max_pool.
#include <limits>

#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

float window_max(const MaxPoolArgs& a, std::int32_t oy, std::int32_t ox, std::int32_t c) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.in_h} * a.in_w;
  const std::int32_t top = oy * a.stride_h - a.pad_top;
  const std::int32_t left = ox * a.stride_w - a.pad_left;
  float largest = -std::numeric_limits<float>::infinity();
  for (std::int32_t y = std::max(top, 0); y < std::min(top + a.kernel_h, a.in_h); ++y) {
    for (std::int32_t x = std::max(left, 0); x < std::min(left + a.kernel_w, a.in_w); ++x) {
      largest = std::max(largest, a.x[blocked(c, std::ptrdiff_t{y} * a.in_w + x, pixels)]);
    }
  }
  return largest;
}

}  // namespace

void max_pool(const MaxPoolArgs& a) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.out_h} * a.out_w;
  for (std::int32_t c = 0; c < blocks_of(a.channels) * kBlock; ++c) {
    for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
      for (std::int32_t ox = 0; ox < a.out_w; ++ox) {
        float& y = a.y[blocked(c, std::ptrdiff_t{oy} * a.out_w + ox, pixels)];
        y = c < a.channels ? window_max(a, oy, ox, c) : 0.0f;
      }
    }
  }
}

}  // namespace mien::kernels::ref
