// Vectors of fma_peak for ARM tiers that multiply 8-bit integers.
#pragma once

#include "kernels/common/neon.h"
#include "kernels/fma_peak/integer_peak.h"

namespace mien::kernels::MIEN_TIER {
namespace {

struct IntegerVector {
  using Sum = int32x4_t;
  static constexpr int kSums = 12;

  static Sum all(int value) { return vdupq_n_s32(value); }
  static Sum add(Sum a, Sum b) { return vaddq_s32(a, b); }
  static Sum bit_and(Sum a, Sum b) { return vandq_s32(a, b); }
  static Sum bit_or(Sum a, Sum b) { return vorrq_s32(a, b); }
  static void store(Sum sum, float* y) {
    const Vec floats = vcvtq_f32_s32(sum);
    store_pair(y, {floats, floats});
  }
};

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
