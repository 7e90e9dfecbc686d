#include "kernels/common/neon.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Up to 4 values of a channel vector; the parameters are not padded to whole blocks.
Vec load_channels(const float* values, std::int32_t first, std::int32_t channels, float otherwise) {
  float lanes[kLanes];
  for (std::int32_t i = 0; i < kLanes; ++i) {
    lanes[i] = first + i < channels ? values[first + i] : otherwise;
  }
  return vld1q_f32(lanes);
}

// Four channels of all pixels of a block.
void half_block(const BatchNormArgs& a, const float* x, float* y, std::int32_t first) {
  const Vec mean = load_channels(a.mean, first, a.channels, 0.0f);
  const Vec variance = load_channels(a.variance, first, a.channels, 1.0f);
  const Vec gain = load_channels(a.gain, first, a.channels, 0.0f);
  const Vec offset = load_channels(a.offset, first, a.channels, 0.0f);
  const Vec deviation = square_root(vaddq_f32(variance, splat(a.epsilon)));
  const uint32x4_t mask = lane_mask(first, a.channels);
  for (std::int32_t p = 0; p < a.pixels; ++p, x += kBlock, y += kBlock) {
    const Vec centred = divide(vsubq_f32(vld1q_f32(x), mean), deviation);
    vst1q_f32(y, only(mask, fma(offset, centred, gain)));
  }
}

}  // namespace

void batch_norm(const BatchNormArgs& a) {
  for (std::int32_t first = 0; first < blocks_of(a.channels) * kBlock; first += kLanes) {
    const std::ptrdiff_t at = std::ptrdiff_t{first / kBlock} * a.pixels * kBlock + first % kBlock;
    half_block(a, a.x + at, a.y + at, first);
  }
}

}  // namespace mien::kernels::MIEN_TIER
