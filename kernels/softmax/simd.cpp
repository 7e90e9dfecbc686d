// The softmax kernel of all vector tiers.
#include <limits>

#include "kernels/common/simd.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// One pixel, whose blocks are `plane` floats apart.
class Pixel {
 public:
  Pixel(const SoftmaxArgs& a, std::int32_t index)
      : channels_(a.channels),
        plane_(std::ptrdiff_t{a.pixels} * kBlock),
        x_(a.x + std::ptrdiff_t{index} * kBlock),
        y_(a.y + std::ptrdiff_t{index} * kBlock) {}

  // The maximum, and below the sum, in all lanes.
  [[nodiscard]] Vec largest() const {
    const Vec lowest = splat(-std::numeric_limits<float>::infinity());
    Vec best = lowest;
    for_each_vector([&](std::ptrdiff_t at, Mask mask) {
      best = max(best, choose(mask, load(x_ + at), lowest));
    });
    return largest_lane(best);
  }
  // Stores y = exp(x - top) and returns the sum.
  [[nodiscard]] Vec exponentials(Vec top) const {
    Vec sum = splat(0.0f);
    for_each_vector([&](std::ptrdiff_t at, Mask mask) {
      const Vec power = only(mask, exp(subtract(load(x_ + at), top)));
      sum = add(sum, power);
      store(y_ + at, power);
    });
    return sum_of_lanes(sum);
  }
  void divide_by(Vec total) const {
    for_each_vector([&](std::ptrdiff_t at, Mask) { store(y_ + at, divide(load(y_ + at), total)); });
  }

 private:
  // Calls run(offset, mask of the channels that exist).
  template <class Run>
  void for_each_vector(const Run& run) const {
    std::ptrdiff_t block = 0;
    for (std::int32_t channel = 0; channel < channels_; channel += kBlock, block += plane_) {
      for (std::int32_t lane = 0; lane < kBlock; lane += kLanes) {
        run(block + lane, lane_mask(channel + lane, channels_));
      }
    }
  }

  std::int32_t channels_;
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
