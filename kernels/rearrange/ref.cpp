// The reference kernel of rearrange.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {

void rearrange(const RearrangeArgs& a) {
  const std::int32_t sizes[3] = {a.in_h, a.in_w, a.in_c};
  const std::ptrdiff_t in_pixels = std::ptrdiff_t{a.in_h} * a.in_w;
  const std::ptrdiff_t out_pixels = std::ptrdiff_t{a.out_h} * a.out_w;
  for (std::int32_t c = 0; c < blocks_of(a.out_c) * kBlock; ++c) {
    for (std::ptrdiff_t p = 0; p < out_pixels; ++p) {
      std::ptrdiff_t rest = p * a.out_c + c;  // the element's index
      std::ptrdiff_t at[3] = {};
      for (int i = 2; i >= 0; --i) {
        const auto axis = static_cast<std::size_t>(a.order[i]);
        at[axis] = rest % sizes[axis];
        rest /= sizes[axis];
      }
      const auto channel = static_cast<std::int32_t>(at[2]);
      a.y[blocked(c, p, out_pixels)] =
          c < a.out_c ? a.x[blocked(channel, at[0] * a.in_w + at[1], in_pixels)] : 0.0f;
    }
  }
}

}  // namespace mien::kernels::ref
