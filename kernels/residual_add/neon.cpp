// The neon and neon32 tiers of residual_add.
#include "kernels/common/neon.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void residual_add(const ResidualAddArgs& a) {
  const float* x = a.x;
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    for (std::int32_t row = 0; row < a.h; ++row) {
      const std::ptrdiff_t from =
          (std::ptrdiff_t{block} * a.residual_h + row + a.residual_top) * a.residual_w +
          a.residual_left;
      const float* r = a.residual + from * kBlock;
      for (std::int32_t column = 0; column < a.w; ++column, x += kBlock, y += kBlock, r += kBlock) {
        const Pair value = load_pair(x), residual = load_pair(r);
        store_pair(y, {vaddq_f32(value.low, residual.low), vaddq_f32(value.high, residual.high)});
      }
    }
  }
}

}  // namespace mien::kernels::MIEN_TIER
