// Half precision on NEON (ARMv8.2 with FP16): vectors of 8 values.
#pragma once

#include "kernels/common/neon.h"

namespace mien::kernels::MIEN_TIER {

using Half = std::uint16_t;  // fp16 bits
constexpr std::int32_t kHalves = 8;

namespace {

using HalfVec = float16x8_t;

[[maybe_unused]] inline HalfVec load_halves(const Half* at) {
  return vreinterpretq_f16_u16(vld1q_u16(at));
}
[[maybe_unused]] inline void store_halves(Half* at, HalfVec x) {
  vst1q_u16(at, vreinterpretq_u16_f16(x));
}
[[maybe_unused]] inline HalfVec splat_halves(float x) {
  return vdupq_n_f16(static_cast<float16_t>(x));
}
[[maybe_unused]] inline HalfVec to_half(Pair x) {
  return vcvt_high_f16_f32(vcvt_f16_f32(x.low), x.high);
}
[[maybe_unused]] inline Pair widened(HalfVec x) {
  return {vcvt_f32_f16(vget_low_f16(x)), vcvt_high_f32_f16(x)};
}
// Replaces infinities and NaN by the largest finite value, with the sign of an infinity.
[[maybe_unused]] inline HalfVec finite(HalfVec x) {
  const HalfVec largest = splat_halves(65504.0f);
  return vmaxnmq_f16(vminnmq_f16(x, largest), vnegq_f16(largest));
}
// a * b[kLane], and sum + a * b[kLane]. Inline assembly, because gcc 12 first copies the lane to a
// whole register. Emulation uses the intrinsics.
template <int kLane>
inline HalfVec multiply_lane(HalfVec a, HalfVec b) {
#if defined(__clang__) || !defined(__aarch64__)
  return vmulq_laneq_f16(a, b, kLane);
#else
  HalfVec product;
  asm("fmul %0.8h, %1.8h, %2.h[%3]" : "=w"(product) : "w"(a), "x"(b), "i"(kLane));
  return product;
#endif
}
template <int kLane>
inline HalfVec fma_lane(HalfVec sum, HalfVec a, HalfVec b) {
#if defined(__clang__) || !defined(__aarch64__)
  return vfmaq_laneq_f16(sum, a, b, kLane);
#else
  asm("fmla %0.8h, %1.8h, %2.h[%3]" : "+w"(sum) : "w"(a), "x"(b), "i"(kLane));
  return sum;
#endif
}

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
