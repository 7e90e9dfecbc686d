// The residual_add kernel of all vector tiers.
#include "kernels/common/simd.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void residual_add(const ResidualAddArgs& a) {
  const std::ptrdiff_t row_elems = std::ptrdiff_t{a.w} * kBlock;
  const float* x = a.x;
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    for (std::int32_t row = 0; row < a.h; ++row) {
      const std::ptrdiff_t from =
          (std::ptrdiff_t{block} * a.residual_h + row + a.residual_top) * a.residual_w +
          a.residual_left;
      const float* r = a.residual + from * kBlock;
      for (std::ptrdiff_t i = 0; i < row_elems; i += kBlock) {
        store_block(y + i, add(load_block(x + i), load_block(r + i)));
      }
      x += row_elems;
      y += row_elems;
    }
  }
}

}  // namespace mien::kernels::MIEN_TIER
