// The reference kernel of slice.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {

void slice(const SliceArgs& a) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.h} * a.w;
  const std::ptrdiff_t in_pixels = std::ptrdiff_t{a.in_h} * a.in_w;
  for (std::int32_t c = 0; c < blocks_of(a.channels) * kBlock; ++c) {
    for (std::int32_t oy = 0; oy < a.h; ++oy) {
      for (std::int32_t ox = 0; ox < a.w; ++ox) {
        const std::ptrdiff_t from = std::ptrdiff_t{a.top + oy} * a.in_w + a.left + ox;
        a.y[blocked(c, std::ptrdiff_t{oy} * a.w + ox, pixels)] =
            c < a.channels ? a.x[blocked(a.first_channel + c, from, in_pixels)] : 0.0f;
      }
    }
  }
}

}  // namespace mien::kernels::ref
