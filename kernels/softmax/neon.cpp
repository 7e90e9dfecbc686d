// The neon and neon32 tiers of softmax.
#include <limits>

#include "kernels/common/neon_activation.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// One pixel, whose blocks are `plane` floats apart.
class Pixel {
 public:
  Pixel(const SoftmaxArgs& a, std::int32_t index)
      : channels_(a.channels),
        padded_(blocks_of(a.channels) * kBlock),
        plane_(std::ptrdiff_t{a.pixels} * kBlock),
        x_(a.x + std::ptrdiff_t{index} * kBlock),
        y_(a.y + std::ptrdiff_t{index} * kBlock) {}

  [[nodiscard]] float largest() const {
    const Vec lowest = splat(-std::numeric_limits<float>::infinity());
    Vec best = lowest;
    for (std::int32_t c = 0; c < padded_; c += kLanes) {
      best = vmaxq_f32(best, vbslq_f32(lane_mask(c, channels_), vld1q_f32(x_ + at(c)), lowest));
    }
    return largest_lane(best);
  }
  // Stores y = exp(x - top) and returns the sum.
  float exponentials(float top) const {
    Vec sum = splat(0.0f);
    for (std::int32_t c = 0; c < padded_; c += kLanes) {
      const Vec power = exp(vsubq_f32(vld1q_f32(x_ + at(c)), splat(top)));
      const Vec masked = only(lane_mask(c, channels_), power);
      sum = vaddq_f32(sum, masked);
      vst1q_f32(y_ + at(c), masked);
    }
    return sum_of_lanes(sum);
  }
  void divide_by(float total) const {
    for (std::int32_t c = 0; c < padded_; c += kLanes) {
      vst1q_f32(y_ + at(c), divide(vld1q_f32(y_ + at(c)), splat(total)));
    }
  }

 private:
  [[nodiscard]] std::ptrdiff_t at(std::int32_t c) const { return c / kBlock * plane_ + c % kBlock; }

  std::int32_t channels_, padded_;
  std::ptrdiff_t plane_;
  const float* x_;
  float* y_;
};

}  // namespace

void softmax(const SoftmaxArgs& a) {
  for (std::int32_t p = 0; p < a.pixels; ++p) {
    const Pixel pixel(a, p);
    pixel.divide_by(pixel.exponentials(pixel.largest()));
  }
}

}  // namespace mien::kernels::MIEN_TIER
