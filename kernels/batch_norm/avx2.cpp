#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {
namespace {

// Up to 8 values of a channel vector; the parameters are not padded to whole blocks.
Vec load_channels(const float* values, std::int32_t block, std::int32_t channels, float otherwise) {
  float lanes[kLanes];
  for (std::int32_t i = 0; i < kLanes; ++i) {
    const std::int32_t channel = block * kLanes + i;
    lanes[i] = channel < channels ? values[channel] : otherwise;
  }
  return _mm256_loadu_ps(lanes);
}

}  // namespace

void batch_norm(const BatchNormArgs& a) {
  const float* x = a.x;
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    const Vec mean = load_channels(a.mean, block, a.channels, 0.0f);
    const Vec variance = load_channels(a.variance, block, a.channels, 1.0f);
    const Vec gain = load_channels(a.gain, block, a.channels, 0.0f);
    const Vec offset = load_channels(a.offset, block, a.channels, 0.0f);
    const Vec deviation = _mm256_sqrt_ps(_mm256_add_ps(variance, _mm256_set1_ps(a.epsilon)));
    const Vec mask = lane_mask(block, a.channels);
    for (std::int32_t p = 0; p < a.pixels; ++p, x += kLanes, y += kLanes) {
      const Vec centred = _mm256_div_ps(_mm256_sub_ps(_mm256_loadu_ps(x), mean), deviation);
      _mm256_storeu_ps(y, _mm256_and_ps(_mm256_fmadd_ps(centred, gain, offset), mask));
    }
  }
}

}  // namespace mien::kernels::avx2
