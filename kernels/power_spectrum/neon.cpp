// The neon and neon32 tiers of power_spectrum.
#include "kernels/common/neon.h"
#include "kernels/families.h"
#include "kernels/power_spectrum/real_transform.h"

namespace mien::kernels::MIEN_TIER {
namespace {

struct Simd {
  static constexpr std::int32_t kLanes = MIEN_TIER::kLanes;
  using Vec = float32x4_t;

  static Vec splat(float x) { return vdupq_n_f32(x); }
  static Vec load(const float* at) { return vld1q_f32(at); }
  static void store(float* at, Vec x) { vst1q_f32(at, x); }
  static Vec add(Vec a, Vec b) { return vaddq_f32(a, b); }
  static Vec sub(Vec a, Vec b) { return vsubq_f32(a, b); }
  static Vec mul(Vec a, Vec b) { return vmulq_f32(a, b); }
  static Vec add_product(Vec sum, Vec a, Vec b) { return fma(sum, a, b); }
  static Vec subtract_product(Vec sum, Vec a, Vec b) { return fnma(sum, a, b); }

  static void deinterleave(const float* x, Vec& even, Vec& odd) {
    const float32x4x2_t pairs = vld2q_f32(x);
    even = pairs.val[0];
    odd = pairs.val[1];
  }

  static void transpose(Vec* v) {
    const float32x4x2_t upper = vtrnq_f32(v[0], v[1]), lower = vtrnq_f32(v[2], v[3]);
    for (int i = 0; i < 2; ++i) {
      v[i] = vcombine_f32(vget_low_f32(upper.val[i]), vget_low_f32(lower.val[i]));
      v[i + 2] = vcombine_f32(vget_high_f32(upper.val[i]), vget_high_f32(lower.val[i]));
    }
  }

  static Vec reversed(Vec x) {
    const Vec pairs = vrev64q_f32(x);
    return vcombine_f32(vget_high_f32(pairs), vget_low_f32(pairs));
  }
};

}  // namespace

void power_spectrum(const PowerSpectrumArgs& a) { RealTransform<Simd>(a).power(); }

}  // namespace mien::kernels::MIEN_TIER
