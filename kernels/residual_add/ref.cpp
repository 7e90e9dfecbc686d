// The reference kernel of residual_add.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {

void residual_add(const ResidualAddArgs& a) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.h} * a.w;
  const std::ptrdiff_t residual_pixels = std::ptrdiff_t{a.residual_h} * a.residual_w;
  for (std::int32_t c = 0; c < blocks_of(a.channels) * kBlock; ++c) {
    for (std::int32_t y = 0; y < a.h; ++y) {
      for (std::int32_t x = 0; x < a.w; ++x) {
        const std::ptrdiff_t at = blocked(c, std::ptrdiff_t{y} * a.w + x, pixels);
        const std::ptrdiff_t from =
            std::ptrdiff_t{y + a.residual_top} * a.residual_w + x + a.residual_left;
        a.y[at] = a.x[at] + a.residual[blocked(c, from, residual_pixels)];
      }
    }
  }
}

}  // namespace mien::kernels::ref
