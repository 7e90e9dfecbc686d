// The normalize kernel of all vector tiers: a plain loop over the 8 channels of a block, which
// compilers vectorize.
#include "kernels/common/lanes.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// One pixel; its blocks are `plane` floats apart.
class NormalizedPixel {
 public:
  NormalizedPixel(const NormalizeArgs& a, std::int32_t index)
      : x_(a.x + std::ptrdiff_t{index} * kBlockLanes),
        y_(a.y + std::ptrdiff_t{index} * kBlockLanes),
        plane_(std::ptrdiff_t{a.pixels} * kBlockLanes),
        channels_(a.channels) {}

  [[nodiscard]] float mean() const {
    return average([](float x) { return x; });
  }
  [[nodiscard]] float variance(float mean) const {
    return average([mean](float x) { return (x - mean) * (x - mean); });
  }
  void write(float mean, float scale) const {
    for (std::int32_t first = 0; first < channels_; first += kBlockLanes) {
      float result[kBlockLanes];
      for (int i = 0; i < kBlockLanes; ++i) {
        result[i] = (block(x_, first)[i] - mean) * scale;
      }
      store_lanes(result, channels_ - first, block(y_, first));
    }
  }

 private:
  template <class Float>
  [[nodiscard]] Float* block(Float* map, std::int32_t first) const {
    return map + first / kBlockLanes * plane_;
  }

  template <class Function>
  [[nodiscard]] float average(const Function& function) const {
    float sums[kBlockLanes] = {};
    for (std::int32_t first = 0; first < channels_; first += kBlockLanes) {
      for (int i = 0; i < kBlockLanes; ++i) {
        sums[i] += first + i < channels_ ? function(block(x_, first)[i]) : 0.0f;
      }
    }
    float sum = 0.0f;
    for (const float one : sums) {
      sum += one;
    }
    return sum / static_cast<float>(channels_);
  }

  const float* x_;
  float* y_;
  std::ptrdiff_t plane_;
  std::int32_t channels_;
};

}  // namespace

void normalize(const NormalizeArgs& a) {
  for (std::int32_t p = 0; p < a.pixels; ++p) {
    const NormalizedPixel pixel(a, p);
    const float mean = pixel.mean();
    pixel.write(mean, 1.0f / __builtin_sqrtf(pixel.variance(mean) + a.epsilon));
  }
}

}  // namespace mien::kernels::MIEN_TIER
