#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {

// Four sums hide the latency of additions, and err less on large maps than one would.
void global_average_pool(const GlobalAveragePoolArgs& a) {
  const Vec scale = _mm256_set1_ps(1.0f / static_cast<float>(a.pixels));
  const float* x = a.x;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    Vec sum[4] = {_mm256_setzero_ps(), _mm256_setzero_ps(), _mm256_setzero_ps(),
                  _mm256_setzero_ps()};
    std::int32_t p = 0;
    for (; p + 4 <= a.pixels; p += 4) {
      for (Vec& one : sum) {
        one = _mm256_add_ps(one, _mm256_loadu_ps(x));
        x += kLanes;
      }
    }
    for (; p < a.pixels; ++p, x += kLanes) {
      sum[0] = _mm256_add_ps(sum[0], _mm256_loadu_ps(x));
    }
    const Vec total = _mm256_add_ps(_mm256_add_ps(sum[0], sum[1]), _mm256_add_ps(sum[2], sum[3]));
    _mm256_storeu_ps(a.y + std::ptrdiff_t{block} * kLanes, _mm256_mul_ps(total, scale));
  }
}

}  // namespace mien::kernels::avx2
