// Copies small maps with zero padding, so that every window lies inside the copy.
#pragma once

#include <algorithm>

#include "kernels/depthwise/depthwise.h"

namespace mien::kernels {
namespace {

// A block of 8 channels of a map with its padding, on the stack: up to kMaxPixels pixels.
template <std::int32_t kMaxPixels>
class Padded {
 public:
  explicit Padded(const DepthwiseArgs& a) : a_(a), inner_(a) {
    inner_.in_h = (a.out_h - 1) * a.stride_h + a.kernel_h;
    inner_.in_w = (a.out_w - 1) * a.stride_w + a.kernel_w;
    inner_.pad_top = inner_.pad_left = 0;
    rows_ = std::min(a.in_h, inner_.in_h - a.pad_top);
    columns_ = std::min(a.in_w, inner_.in_w - a.pad_left);
    std::fill_n(map_, inner_.in_h * inner_.in_w * kChannels, 0.0f);
  }
  static bool accepts(const DepthwiseArgs& a) {
    const std::int32_t h = (a.out_h - 1) * a.stride_h + a.kernel_h;
    const std::int32_t w = (a.out_w - 1) * a.stride_w + a.kernel_w;
    const bool leaves = a.pad_top > 0 || a.pad_left > 0 || h > a.in_h || w > a.in_w;
    return leaves && h <= kMaxPixels && w <= kMaxPixels && h * w <= kMaxPixels;
  }
  [[nodiscard]] const DepthwiseArgs& args() const { return inner_; }
  const float* filled(const float* x) {
    for (std::int32_t i = 0; i < rows_; ++i) {
      const float* from = x + std::ptrdiff_t{i} * a_.in_w * kChannels;
      float* to = map_ + ((i + a_.pad_top) * inner_.in_w + a_.pad_left) * kChannels;
      for (std::int32_t k = 0; k < columns_ * kChannels; ++k) {
        to[k] = from[k];
      }
    }
    return map_;
  }

 private:
  static constexpr std::int32_t kChannels = 8;

  const DepthwiseArgs& a_;
  DepthwiseArgs inner_;
  std::int32_t rows_, columns_;
  float map_[kMaxPixels * kChannels];
};

}  // namespace
}  // namespace mien::kernels
