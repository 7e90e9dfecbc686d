// The neondot tier of fma_peak.
#include "kernels/common/neon.h"
#include "kernels/families.h"
#include "kernels/fma_peak/integer_peak.h"

namespace mien::kernels::neondot {
namespace {

struct Vector {
  using Sum = int32x4_t;
  static constexpr int kSums = 12;
  static constexpr int kProducts = 16;

  static Sum all(int value) { return vdupq_n_s32(value); }
  static Sum add(Sum a, Sum b) { return vaddq_s32(a, b); }
  static Sum bit_and(Sum a, Sum b) { return vandq_s32(a, b); }
  static Sum bit_or(Sum a, Sum b) { return vorrq_s32(a, b); }
  static Sum multiply_add(Sum sum, Sum value, Sum weight) {
    return vdotq_s32(sum, vreinterpretq_s8_s32(value), vreinterpretq_s8_s32(weight));
  }
  static void store(Sum sum, float* y) {
    const Vec floats = vcvtq_f32_s32(sum);
    store_pair(y, {floats, floats});
  }
};

}  // namespace

void fma_peak(const FmaPeakArgs& a) { integer_peak<Vector>(a); }

}  // namespace mien::kernels::neondot
