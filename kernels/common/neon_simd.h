// The vectors of kernels/common/simd.h on NEON.
#pragma once

#include "kernels/common/neon_activation.h"

#include "kernels/common/two_vectors.h"

namespace mien::kernels::MIEN_TIER {
namespace {

class LaneShift {
 public:
  // `lanes` in 0..7.
  explicit LaneShift(std::int32_t lanes) : lanes_(lanes) {}

  // Lanes `lanes` .. `lanes` + 7 of the concatenation of `low` and `high`.
  [[nodiscard]] BlockVec apply(BlockVec low, BlockVec high) const {
    float both[2 * kBlock];
    store(both, low.low);
    store(both + kLanes, low.high);
    store(both + kBlock, high.low);
    store(both + kBlock + kLanes, high.high);
    return load_block(both + lanes_);
  }

 private:
  std::int32_t lanes_;
};

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
