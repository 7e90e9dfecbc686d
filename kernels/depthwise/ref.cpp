// The reference kernel of depthwise.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

double window_sum(const DepthwiseArgs& a, std::int32_t oy, std::int32_t ox, std::int32_t c) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.in_h} * a.in_w;
  const std::uint16_t* weights = a.weights + c / kBlock * a.kernel_h * a.kernel_w * kBlock;
  double sum = 0.0;
  for (std::int32_t ky = 0; ky < a.kernel_h; ++ky) {
    for (std::int32_t kx = 0; kx < a.kernel_w; ++kx) {
      const std::int32_t y = oy * a.stride_h + ky - a.pad_top;
      const std::int32_t x = ox * a.stride_w + kx - a.pad_left;
      if (y < 0 || y >= a.in_h || x < 0 || x >= a.in_w) {
        continue;
      }
      const double w = half_to_float(weights[(ky * a.kernel_w + kx) * kBlock + c % kBlock]);
      sum += w * static_cast<double>(a.x[blocked(c, std::ptrdiff_t{y} * a.in_w + x, pixels)]);
    }
  }
  return sum;
}

}  // namespace

void depthwise(const DepthwiseArgs& a) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.out_h} * a.out_w;
  for (std::int32_t c = 0; c < blocks_of(a.channels) * kBlock; ++c) {
    for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
      for (std::int32_t ox = 0; ox < a.out_w; ++ox) {
        float& y = a.y[blocked(c, std::ptrdiff_t{oy} * a.out_w + ox, pixels)];
        const double sum = half_to_float(a.bias[c]) + window_sum(a, oy, ox, c);
        y = c < a.channels ? static_cast<float>(activated(sum, a.activation, c)) : 0.0f;
      }
    }
  }
}

}  // namespace mien::kernels::ref
