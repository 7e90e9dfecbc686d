// The avx2 tier of concat.
#include <cstring>

#include "kernels/common/avx2_lanes.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {

// If the channels of a fill its last block, the blocks of b are copied as they are. Otherwise each
// further block takes lanes from two blocks of b, or from the last of a and the first of b.
void concat(const ConcatArgs& a) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.pixels} * kLanes;
  const std::int32_t whole = a.a_channels / kLanes, used = a.a_channels % kLanes;
  const std::int32_t b_blocks = blocks_of(a.b_channels);
  const auto bytes = [&](std::int32_t blocks) {
    return static_cast<std::size_t>(blocks * plane) * sizeof(float);
  };
  std::memcpy(a.y, a.a, bytes(whole));
  if (used == 0) {
    std::memcpy(a.y + whole * plane, a.b, bytes(b_blocks));
    return;
  }
  const LaneShift shift(kLanes - used);
  const std::int32_t blocks = blocks_of(a.a_channels + a.b_channels);
  for (std::int32_t block = whole; block < blocks; ++block) {
    const std::int32_t second = block - whole;  // the block of b in the upper lanes
    const float* low = second > 0 ? a.b + (second - 1) * plane : nullptr;
    const float* high = second < b_blocks ? a.b + second * plane : nullptr;
    for (std::ptrdiff_t p = 0; p < plane; p += kLanes) {
      const Vec from_b = shift.apply(load_or_zero(low, p), load_or_zero(high, p));
      const Vec from_a = low == nullptr ? _mm256_loadu_ps(a.a + whole * plane + p) : from_b;
      _mm256_storeu_ps(a.y + block * plane + p, _mm256_or_ps(from_a, from_b));
    }
  }
}

}  // namespace mien::kernels::avx2
