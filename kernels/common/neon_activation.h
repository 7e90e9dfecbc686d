// Activations of the NEON kernels.
#pragma once

#include <limits>

#include "kernels/common/neon.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// exp(x) to 2 ulp on [-87, 88], clamped outside: 2^n e^r with r in [-ln2/2, ln2/2], a polynomial of
// degree 6 (Cephes expf by S. Moshier).
[[maybe_unused]] inline Vec exp(Vec x) {
  x = vminq_f32(vmaxq_f32(x, splat(-87.0f)), splat(88.0f));
  const Vec n = floor(fma(splat(0.5f), x, splat(1.44269504f)));
  Vec r = fnma(x, n, splat(0.693359375f));
  r = fnma(r, n, splat(-2.12194440e-4f));
  Vec p = splat(1.9875691500e-4f);
  p = fma(splat(1.3981999507e-3f), p, r);
  p = fma(splat(8.3334519073e-3f), p, r);
  p = fma(splat(4.1665795894e-2f), p, r);
  p = fma(splat(1.6666665459e-1f), p, r);
  p = fma(splat(5.0000001201e-1f), p, r);
  p = fma(vaddq_f32(r, splat(1.0f)), p, vmulq_f32(r, r));
  const int32x4_t exponent = vaddq_s32(vcvtq_s32_f32(n), vdupq_n_s32(127));
  return vmulq_f32(p, vreinterpretq_f32_s32(vshlq_n_s32(exponent, 23)));
}

[[maybe_unused]] inline Vec sigmoid(Vec x) {
  return divide(splat(1.0f), vaddq_f32(splat(1.0f), exp(vnegq_f32(x))));
}

// 1 - 2 / (exp(2x) + 1), or near zero, because of cancellation, x - x^3/3 + 2x^5/15 - 17x^7/315.
[[maybe_unused]] inline Vec tanh(Vec x) {
  const Vec one = splat(1.0f);
  const Vec large = vsubq_f32(one, divide(splat(2.0f), vaddq_f32(exp(vaddq_f32(x, x)), one)));
  const Vec s = vmulq_f32(x, x);
  Vec p = splat(62.0f / 2835.0f);
  p = fma(splat(-17.0f / 315.0f), p, s);
  p = fma(splat(2.0f / 15.0f), p, s);
  p = fma(splat(-1.0f / 3.0f), p, s);
  const Vec small = fma(x, vmulq_f32(p, s), x);
  return vbslq_f32(vcltq_f32(vabsq_f32(x), splat(0.2f)), small, large);
}

// Applies an activation other than a clamp to four channels from `first` on.
inline Vec curved(Vec x, const ActivationSpec& activation, std::int32_t first,
                  std::int32_t channels) {
  const uint32x4_t positive = vcgtq_f32(x, splat(0.0f));
  switch (activation.kind) {
    case Activation::kLeakyRelu:
      return vbslq_f32(positive, x, vmulq_f32(x, splat(activation.alpha)));
    case Activation::kPrelu:
      return vbslq_f32(positive, x, vmulq_f32(x, load_half(activation.slopes + first)));
    case Activation::kSigmoid:  // the only one that maps 0 in unused lanes to another value
      return only(lane_mask(first, channels), sigmoid(x));
    case Activation::kTanh:
      return tanh(x);
    default:
      return x;
  }
}

// In place on [pixels][vectors][4]. Not inlined, so that the caller's sums stay in registers.
[[maybe_unused, gnu::noinline]] inline void curve(float* values, std::int32_t vectors,
                                                  std::ptrdiff_t pixels,
                                                  const ActivationSpec& activation,
                                                  std::int32_t first, std::int32_t channels) {
  for (std::ptrdiff_t p = 0; p < pixels; ++p) {
    for (std::int32_t v = 0; v < vectors; ++v, values += kLanes) {
      const Vec value = curved(vld1q_f32(values), activation, first + v * kLanes, channels);
      vst1q_f32(values, value);
    }
  }
}

// An activation prepared for tiles [pixels][vectors] of sums: a range for clamps, otherwise an
// infinite range and a curve.
class Activator {
 public:
  Activator(const ActivationSpec& activation, std::int32_t channels)
      : activation_(activation), channels_(channels) {
    const Activation kind = activation.kind;
    const float infinity = std::numeric_limits<float>::infinity();
    const bool clamps =
        kind == Activation::kRelu || kind == Activation::kRelu6 || kind == Activation::kClamp01;
    curves_ = !clamps && kind != Activation::kNone;
    low_ = splat(clamps ? 0.0f : -infinity);
    high_ = splat(kind == Activation::kRelu6     ? 6.0f
                  : kind == Activation::kClamp01 ? 1.0f
                                                 : infinity);
  }

  [[nodiscard]] bool curves() const { return curves_; }
  [[nodiscard]] Vec low() const { return low_; }
  [[nodiscard]] Vec high() const { return high_; }

  [[nodiscard]] Vec clamped(Vec x) const { return vminq_f32(vmaxq_f32(x, low_), high_); }

  // Applies the curve, if any, to clamped values of a block in place.
  void curve_block(float* values, std::ptrdiff_t pixels, std::int32_t block) const {
    curve(values, kBlock / kLanes, pixels, activation_, block * kBlock, channels_);
  }

  // sums[p][v] holds channels first + 4 v .. first + 4 v + 3.
  template <int kPixels, int kVecs>
  [[gnu::always_inline]] void apply(Vec (&sums)[kPixels][kVecs], std::int32_t first) const {
    MIEN_UNROLLED for (auto& pixel : sums) {
      MIEN_UNROLLED for (Vec& one : pixel) { one = clamped(one); }
    }
    if (curves_) {
      float copy[kPixels * kVecs * kLanes];  // so that the sums themselves stay in registers
      MIEN_UNROLLED for (int i = 0; i < kPixels * kVecs; ++i) {
        vst1q_f32(copy + i * kLanes, sums[i / kVecs][i % kVecs]);
      }
      curve(copy, kVecs, kPixels, activation_, first, channels_);
      MIEN_UNROLLED for (int i = 0; i < kPixels * kVecs; ++i) {
        sums[i / kVecs][i % kVecs] = vld1q_f32(copy + i * kLanes);
      }
    }
  }

 private:
  const ActivationSpec& activation_;
  std::int32_t channels_;
  Vec low_, high_;
  bool curves_;
};

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
