// The reference kernel of conv2d.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

double input_at(const Conv2dArgs& a, std::int32_t y, std::int32_t x, std::int32_t c) {
  if (y < 0 || y >= a.in_h || x < 0 || x >= a.in_w) {
    return 0.0;
  }
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.in_h} * a.in_w;
  const std::ptrdiff_t pixel = std::ptrdiff_t{y} * a.in_w + x;
  return a.x_pixel_elems == kBlock ? a.x[blocked(c, pixel, pixels)]
                                   : a.x[pixel * a.x_pixel_elems + c];
}

double window_sum(const Conv2dArgs& a, std::int32_t oy, std::int32_t ox, std::int32_t o) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{a.kernel_h} * a.kernel_w * a.in_c;
  double sum = 0.0;
  std::ptrdiff_t k = 0;
  for (std::int32_t ky = 0; ky < a.kernel_h; ++ky) {
    for (std::int32_t kx = 0; kx < a.kernel_w; ++kx) {
      const std::int32_t y = oy * a.stride_h + ky - a.pad_top;
      const std::int32_t x = ox * a.stride_w + kx - a.pad_left;
      for (std::int32_t i = 0; i < a.in_c; ++i, ++k) {
        sum += panel_weight(a.weights, a.out_c, reduction, o, k) * input_at(a, y, x, i);
      }
    }
  }
  return sum;
}

}  // namespace

void conv2d(const Conv2dArgs& a) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.out_h} * a.out_w;
  for (std::int32_t o = 0; o < blocks_of(a.out_c) * kBlock; ++o) {
    for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
      for (std::int32_t ox = 0; ox < a.out_w; ++ox) {
        float& y = a.y[blocked(o, std::ptrdiff_t{oy} * a.out_w + ox, pixels)];
        const double sum = half_to_float(a.bias[o]) + window_sum(a, oy, ox, o);
        y = o < a.out_c ? static_cast<float>(activated(sum, a.activation, o)) : 0.0f;
      }
    }
  }
}

}  // namespace mien::kernels::ref
