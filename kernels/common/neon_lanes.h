// Loads eight consecutive channels that span two blocks.
#pragma once

#include "kernels/common/neon.h"

namespace mien::kernels::MIEN_TIER {
namespace {

inline Pair load_pair_or_zero(const float* map, std::ptrdiff_t at) {
  return map == nullptr ? Pair{splat(0.0f), splat(0.0f)} : load_pair(map + at);
}

// Bitwise or: in each lane the operand that is not zero.
[[maybe_unused]] inline Vec either(Vec a, Vec b) {
  return vreinterpretq_f32_u32(vorrq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));
}

// Lanes `first` .. `first` + 7 of the concatenation of `low` and `high`; `first` in 0..7.
inline Pair shifted(Pair low, Pair high, std::int32_t first) {
  float both[2 * kBlock];
  store_pair(both, low);
  store_pair(both + kBlock, high);
  return load_pair(both + first);
}

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
