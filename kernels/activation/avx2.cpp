// The avx2 tier of activate.
#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {

void activate(const ActivateArgs& a) {
  const float* x = a.x;
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    const Vec mask = lane_mask(block, a.channels);
    for (std::int32_t p = 0; p < a.pixels; ++p, x += kLanes, y += kLanes) {
      const Vec value = activated(_mm256_loadu_ps(x), a.activation, block, a.channels);
      _mm256_storeu_ps(y, _mm256_and_ps(value, mask));
    }
  }
}

}  // namespace mien::kernels::avx2
