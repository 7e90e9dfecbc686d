// The avx2 tier of global_average_pool.
#include "kernels/common/avx2.h"
#include "kernels/families.h"
#include "kernels/global_average_pool/parts.h"

namespace mien::kernels::avx2 {
namespace {

// Four sums hide the latency of additions.
void sum_of_part(const float* x, std::int32_t pixels, float (&part)[8]) {
  Vec sum[4] = {_mm256_setzero_ps(), _mm256_setzero_ps(), _mm256_setzero_ps(), _mm256_setzero_ps()};
  std::int32_t p = 0;
  for (; p + 4 <= pixels; p += 4) {
    for (Vec& one : sum) {
      one = _mm256_add_ps(one, _mm256_loadu_ps(x));
      x += kLanes;
    }
  }
  for (; p < pixels; ++p, x += kLanes) {
    sum[0] = _mm256_add_ps(sum[0], _mm256_loadu_ps(x));
  }
  _mm256_storeu_ps(part,
                   _mm256_add_ps(_mm256_add_ps(sum[0], sum[1]), _mm256_add_ps(sum[2], sum[3])));
}

}  // namespace

void global_average_pool(const GlobalAveragePoolArgs& a) { mean_by_parts(a, sum_of_part); }

}  // namespace mien::kernels::avx2
