// The avx2 tier of residual_add.
#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {

void residual_add(const ResidualAddArgs& a) {
  const float* x = a.x;
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    for (std::int32_t row = 0; row < a.h; ++row) {
      const std::ptrdiff_t from =
          (std::ptrdiff_t{block} * a.residual_h + row + a.residual_top) * a.residual_w +
          a.residual_left;
      const float* r = a.residual + from * kLanes;
      for (std::int32_t column = 0; column < a.w; ++column, x += kLanes, y += kLanes, r += kLanes) {
        _mm256_storeu_ps(y, _mm256_add_ps(_mm256_loadu_ps(x), _mm256_loadu_ps(r)));
      }
    }
  }
}

}  // namespace mien::kernels::avx2
