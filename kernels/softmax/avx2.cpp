// The avx2 tier of softmax.
#include <limits>

#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {
namespace {

template <class Combine>
float across(Vec v, Combine combine) {
  v = combine(v, _mm256_permute2f128_ps(v, v, 1));
  v = combine(v, _mm256_permute_ps(v, 0x4E));
  v = combine(v, _mm256_permute_ps(v, 0xB1));
  return _mm256_cvtss_f32(v);
}

Vec larger(Vec a, Vec b) { return _mm256_max_ps(a, b); }
Vec sum_of(Vec a, Vec b) { return _mm256_add_ps(a, b); }

}  // namespace

void softmax(const SoftmaxArgs& a) {
  const std::int32_t blocks = blocks_of(a.channels);
  const std::ptrdiff_t plane = std::ptrdiff_t{a.pixels} * kLanes;
  const Vec lowest = _mm256_set1_ps(-std::numeric_limits<float>::infinity());
  for (std::int32_t p = 0; p < a.pixels; ++p) {
    const float* x = a.x + std::ptrdiff_t{p} * kLanes;
    float* y = a.y + std::ptrdiff_t{p} * kLanes;
    Vec best = lowest;
    for (std::int32_t b = 0; b < blocks; ++b) {
      const Vec value = _mm256_loadu_ps(x + b * plane);
      best = larger(best, _mm256_blendv_ps(lowest, value, lane_mask(b, a.channels)));
    }
    const Vec top = _mm256_set1_ps(across(best, larger));
    Vec sum = _mm256_setzero_ps();
    for (std::int32_t b = 0; b < blocks; ++b) {
      const Vec power = exp(_mm256_sub_ps(_mm256_loadu_ps(x + b * plane), top));
      const Vec masked = _mm256_and_ps(power, lane_mask(b, a.channels));
      sum = sum_of(sum, masked);
      _mm256_storeu_ps(y + b * plane, masked);
    }
    const Vec total = _mm256_set1_ps(across(sum, sum_of));
    for (std::int32_t b = 0; b < blocks; ++b) {
      _mm256_storeu_ps(y + b * plane, _mm256_div_ps(_mm256_loadu_ps(y + b * plane), total));
    }
  }
}

}  // namespace mien::kernels::avx2
