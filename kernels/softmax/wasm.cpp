// The wasm tier of softmax.
#include <limits>

#include "kernels/common/wasm_activation.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
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

  // The maximum, and below the sum, in all lanes.
  [[nodiscard]] Vec largest() const {
    const Vec lowest = splat(-std::numeric_limits<float>::infinity());
    Vec best = lowest;
    for (std::int32_t c = 0; c < padded_; c += kLanes) {
      best = at_least(best, wasm_v128_bitselect(load(x_ + at(c)), lowest, lane_mask(c, channels_)));
    }
    return across(best, at_least);
  }
  // Stores y = exp(x - top) and returns the sum.
  [[nodiscard]] Vec exponentials(Vec top) const {
    Vec sum = splat(0.0f);
    for (std::int32_t c = 0; c < padded_; c += kLanes) {
      const Vec power = exp(wasm_f32x4_sub(load(x_ + at(c)), top));
      const Vec masked = only(lane_mask(c, channels_), power);
      sum = wasm_f32x4_add(sum, masked);
      store(y_ + at(c), masked);
    }
    return sum_of_lanes(sum);
  }
  void divide_by(Vec total) const {
    for (std::int32_t c = 0; c < padded_; c += kLanes) {
      store(y_ + at(c), wasm_f32x4_div(load(y_ + at(c)), total));
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

}  // namespace mien::kernels::wasm
