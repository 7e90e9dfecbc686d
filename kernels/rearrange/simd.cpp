// The rearrange kernel of all vector tiers: one pass over both maps in the order of the elements.
#include "kernels/common/lanes.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Distances in memory between consecutive elements along an axis; channels have one distance within
// a block and another between blocks.
class Strides {
 public:
  explicit Strides(const RearrangeArgs& a) : sizes_{a.in_h, a.in_w, a.in_c} {
    const std::ptrdiff_t pixels = std::ptrdiff_t{a.in_h} * a.in_w;
    strides_[0] = std::ptrdiff_t{a.in_w} * kBlockLanes;
    strides_[1] = kBlockLanes;
    block_ = pixels * kBlockLanes;
  }
  [[nodiscard]] std::int32_t size(Axis axis) const { return sizes_[static_cast<int>(axis)]; }
  [[nodiscard]] std::ptrdiff_t offset(Axis axis, std::int32_t i) const {
    return axis == Axis::kChannel ? i / kBlockLanes * block_ + i % kBlockLanes
                                  : i * strides_[static_cast<int>(axis)];
  }

 private:
  std::int32_t sizes_[3];
  std::ptrdiff_t strides_[2] = {}, block_ = 0;
};

// Writes elements in sequence.
class Output {
 public:
  explicit Output(const RearrangeArgs& a)
      : y_(a.y), channels_(a.out_c), plane_(std::ptrdiff_t{a.out_h} * a.out_w * kBlockLanes) {}

  void put(float value) {
    y_[channel_ / kBlockLanes * plane_ + channel_ % kBlockLanes] = value;
    if (++channel_ == channels_) {
      for (; channel_ % kBlockLanes != 0; ++channel_) {
        y_[channel_ / kBlockLanes * plane_ + channel_ % kBlockLanes] = 0.0f;
      }
      channel_ = 0;
      y_ += kBlockLanes;
    }
  }

 private:
  float* y_;
  std::int32_t channels_, channel_ = 0;
  std::ptrdiff_t plane_;
};

inline void rearrange_any(const RearrangeArgs& a) {
  const Strides from(a);
  Output to(a);
  for (std::int32_t i = 0; i < from.size(a.order[0]); ++i) {
    const std::ptrdiff_t outer = from.offset(a.order[0], i);
    for (std::int32_t j = 0; j < from.size(a.order[1]); ++j) {
      const float* middle = a.x + outer + from.offset(a.order[1], j);
      for (std::int32_t k = 0; k < from.size(a.order[2]); ++k) {
        to.put(middle[from.offset(a.order[2], k)]);
      }
    }
  }
}

}  // namespace

void rearrange(const RearrangeArgs& args) { rearrange_any(args); }

}  // namespace mien::kernels::MIEN_TIER
