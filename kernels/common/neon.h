// Helpers shared by the NEON kernels. Their sources are compiled once per ARM tier, with MIEN_TIER
// as the tier's namespace: neon (AArch64: 32 registers of 4 floats, multiply by lane) and neon32
// (ARMv7 with VFPv4: 16 registers, no fused multiply by lane). All have internal linkage, so that
// the linker cannot merge code of different tiers.
#pragma once

#include <arm_neon.h>

#include <cstddef>
#include <cstdint>

#include "kernels/activation/activation.h"
#include "kernels/common/unrolled.h"

// AArch64 instructions. Tests that emulate them on other machines define MIEN_NEON64 themselves.
#ifdef __aarch64__
#define MIEN_NEON64
#endif

namespace mien::kernels::MIEN_TIER {

constexpr std::int32_t kLanes = 4;   // floats of a vector
constexpr std::int32_t kBlock = 8;   // channels of a block of a map
constexpr std::int32_t kPanel = 16;  // output channels of a panel of weights

namespace {

using Vec = float32x4_t;
using Mask = uint32x4_t;

// A block of 8 channels.
struct Pair {
  Vec low, high;
};

[[maybe_unused]] inline Vec splat(float x) { return vdupq_n_f32(x); }
[[maybe_unused]] inline Vec load(const float* at) { return vld1q_f32(at); }
[[maybe_unused]] inline void store(float* at, Vec x) { vst1q_f32(at, x); }

[[maybe_unused]] inline Vec add(Vec a, Vec b) { return vaddq_f32(a, b); }
[[maybe_unused]] inline Vec subtract(Vec a, Vec b) { return vsubq_f32(a, b); }
[[maybe_unused]] inline Vec max(Vec a, Vec b) { return vmaxq_f32(a, b); }

[[maybe_unused]] inline Pair load_pair(const float* at) {
  return {vld1q_f32(at), vld1q_f32(at + kLanes)};
}
[[maybe_unused]] inline void store_pair(float* at, Pair x) {
  vst1q_f32(at, x.low);
  vst1q_f32(at + kLanes, x.high);
}

[[maybe_unused]] inline Vec load_half(const std::uint16_t* at) {
  return vcvt_f32_f16(vreinterpret_f16_u16(vld1_u16(at)));
}
#ifdef MIEN_NEON64

[[maybe_unused]] inline Pair load_half_pair(const std::uint16_t* at) {
  const float16x8_t halves = vreinterpretq_f16_u16(vld1q_u16(at));
  return {vcvt_f32_f16(vget_low_f16(halves)), vcvt_high_f32_f16(halves)};
}
// sum + a * b[kLane]
template <int kLane>
inline Vec fma_lane(Vec sum, Vec a, Vec b) {
  return vfmaq_laneq_f32(sum, a, b, kLane);
}
[[maybe_unused]] inline Vec divide(Vec a, Vec b) { return vdivq_f32(a, b); }
[[maybe_unused]] inline Vec square_root(Vec x) { return vsqrtq_f32(x); }
[[maybe_unused]] inline Vec floor(Vec x) { return vrndmq_f32(x); }
[[maybe_unused]] inline Vec sum_of_lanes(Vec x) { return splat(vaddvq_f32(x)); }
[[maybe_unused]] inline Vec largest_lane(Vec x) { return splat(vmaxvq_f32(x)); }

#else

[[maybe_unused]] inline Pair load_half_pair(const std::uint16_t* at) {
  return {load_half(at), load_half(at + kLanes)};
}
template <int kLane>
inline Vec fma_lane(Vec sum, Vec a, Vec b) {
  return vmlaq_lane_f32(sum, a, kLane < 2 ? vget_low_f32(b) : vget_high_f32(b), kLane % 2);
}
// The estimate has 8 correct bits; each Newton step doubles them.
[[maybe_unused]] inline Vec divide(Vec a, Vec b) {
  Vec reciprocal = vrecpeq_f32(b);
  for (int step = 0; step < 3; ++step) {
    reciprocal = vmulq_f32(vrecpsq_f32(b, reciprocal), reciprocal);
  }
  return vmulq_f32(a, reciprocal);
}
[[maybe_unused]] inline Vec square_root(Vec x) {  // ARMv7 has no vector instruction
  float lanes[kLanes];
  vst1q_f32(lanes, x);
  for (float& lane : lanes) {
    lane = __builtin_sqrtf(lane);
  }
  return vld1q_f32(lanes);
}
// For values within the range of a 32-bit integer.
[[maybe_unused]] inline Vec floor(Vec x) {
  const Vec truncated = vcvtq_f32_s32(vcvtq_s32_f32(x));
  const uint32x4_t one = vreinterpretq_u32_f32(splat(1.0f));
  return vsubq_f32(truncated, vreinterpretq_f32_u32(vandq_u32(vcgtq_f32(truncated, x), one)));
}
[[maybe_unused]] inline Vec sum_of_lanes(Vec x) {
  const float32x2_t pairs = vadd_f32(vget_low_f32(x), vget_high_f32(x));
  return vdupq_lane_f32(vpadd_f32(pairs, pairs), 0);
}
[[maybe_unused]] inline Vec largest_lane(Vec x) {
  const float32x2_t pairs = vmax_f32(vget_low_f32(x), vget_high_f32(x));
  return vdupq_lane_f32(vpmax_f32(pairs, pairs), 0);
}

#endif

// sum + a * b
[[maybe_unused]] inline Vec fma(Vec sum, Vec a, Vec b) { return vfmaq_f32(sum, a, b); }
// sum - a * b
[[maybe_unused]] inline Vec fnma(Vec sum, Vec a, Vec b) { return vfmsq_f32(sum, a, b); }

// x where the mask is set, 0 elsewhere.
[[maybe_unused]] inline Vec only(Mask mask, Vec x) {
  return vreinterpretq_f32_u32(vandq_u32(mask, vreinterpretq_u32_f32(x)));
}
// x where the mask is set, `other` elsewhere.
[[maybe_unused]] inline Vec choose(Mask mask, Vec x, Vec other) {
  return vbslq_f32(mask, x, other);
}
// Bitwise or
[[maybe_unused]] inline Vec either(Vec a, Vec b) {
  return vreinterpretq_f32_u32(vorrq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));
}

[[maybe_unused]] inline std::int32_t blocks_of(std::int32_t channels) {
  return (channels + kBlock - 1) / kBlock;
}

// Mask of the lanes of channels first .. first + 3 that exist.
[[maybe_unused]] inline Mask lane_mask(std::int32_t first, std::int32_t channels) {
  static constexpr std::int32_t kOrder[kLanes] = {0, 1, 2, 3};
  return vcltq_s32(vld1q_s32(kOrder), vdupq_n_s32(channels - first));
}

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
