// The avx2 tier of max_pool.
#include <algorithm>
#include <limits>

#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {

void max_pool(const MaxPoolArgs& a) {
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    const float* x = a.x + std::ptrdiff_t{block} * a.in_h * a.in_w * kLanes;
    float* y = a.y + std::ptrdiff_t{block} * a.out_h * a.out_w * kLanes;
    for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
      const std::int32_t top = oy * a.stride_h - a.pad_top;
      for (std::int32_t ox = 0; ox < a.out_w; ++ox, y += kLanes) {
        const std::int32_t left = ox * a.stride_w - a.pad_left;
        Vec largest = _mm256_set1_ps(-std::numeric_limits<float>::infinity());
        for (std::int32_t iy = std::max(top, 0); iy < std::min(top + a.kernel_h, a.in_h); ++iy) {
          for (std::int32_t ix = std::max(left, 0); ix < std::min(left + a.kernel_w, a.in_w);
               ++ix) {
            largest = _mm256_max_ps(
                largest, _mm256_loadu_ps(x + (std::ptrdiff_t{iy} * a.in_w + ix) * kLanes));
          }
        }
        _mm256_storeu_ps(y, _mm256_and_ps(largest, lane_mask(block, a.channels)));
      }
    }
  }
}

}  // namespace mien::kernels::avx2
