// The wasm tier of residual_add.
#include "kernels/common/wasm.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {

void residual_add(const ResidualAddArgs& a) {
  const float* x = a.x;
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    for (std::int32_t row = 0; row < a.h; ++row) {
      const std::ptrdiff_t from =
          (std::ptrdiff_t{block} * a.residual_h + row + a.residual_top) * a.residual_w +
          a.residual_left;
      const float* r = a.residual + from * kBlock;
      for (std::int32_t i = 0; i < a.w * kBlock; i += kLanes) {
        store(y + i, wasm_f32x4_add(load(x + i), load(r + i)));
      }
      x += std::ptrdiff_t{a.w} * kBlock;
      y += std::ptrdiff_t{a.w} * kBlock;
    }
  }
}

}  // namespace mien::kernels::wasm
