// The avx2 tier of slice.
#include "kernels/common/avx2_lanes.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {

// A block of y takes lanes from two blocks of x, unless the slice begins at a block boundary.
void slice(const SliceArgs& a) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kLanes;
  const LaneShift shift(a.first_channel % kLanes);
  const std::int32_t in_blocks = blocks_of(a.first_channel + a.channels);
  float* y = a.y;
  for (std::int32_t block = 0; block < blocks_of(a.channels); ++block) {
    const Vec mask = lane_mask(block, a.channels);
    const std::int32_t from = a.first_channel / kLanes + block;
    const bool two = a.first_channel % kLanes != 0 && from + 1 < in_blocks;
    for (std::int32_t row = 0; row < a.h; ++row) {
      const float* low =
          a.x + from * plane + (std::ptrdiff_t{a.top + row} * a.in_w + a.left) * kLanes;
      const float* high = two ? low + plane : nullptr;
      for (std::ptrdiff_t p = 0; p < std::ptrdiff_t{a.w} * kLanes; p += kLanes, y += kLanes) {
        const Vec lanes = shift.apply(_mm256_loadu_ps(low + p), load_or_zero(high, p));
        _mm256_storeu_ps(y, _mm256_and_ps(lanes, mask));
      }
    }
  }
}

}  // namespace mien::kernels::avx2
