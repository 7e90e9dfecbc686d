// Activations of the WebAssembly kernels.
#pragma once

#include <limits>

#include "kernels/common/wasm.h"

namespace mien::kernels::wasm {
namespace {

// exp(x) to 2 ulp on [-87, 88], clamped outside: 2^n e^r with r in [-ln2/2, ln2/2], a polynomial of
// degree 6 (Cephes expf by S. Moshier). Adding 1.5 * 2^23 rounds to an integer n, in the lowest
// bits.
[[maybe_unused]] inline Vec exp(Vec x) {
  x = min(max(x, splat(-87.0f)), splat(88.0f));
  const Vec shift = splat(12582912.0f);
  const Vec shifted = add_product(shift, x, splat(1.44269504f));
  const Vec n = wasm_f32x4_sub(shifted, shift);
  Vec r = add_product(x, n, splat(-0.693359375f));
  r = add_product(r, n, splat(2.12194440e-4f));
  Vec p = splat(1.9875691500e-4f);
  p = add_product(splat(1.3981999507e-3f), p, r);
  p = add_product(splat(8.3334519073e-3f), p, r);
  p = add_product(splat(4.1665795894e-2f), p, r);
  p = add_product(splat(1.6666665459e-1f), p, r);
  p = add_product(splat(5.0000001201e-1f), p, r);
  p = add_product(wasm_f32x4_add(r, splat(1.0f)), p, wasm_f32x4_mul(r, r));
  const Vec power = wasm_i32x4_add(wasm_i32x4_shl(shifted, 23), splat(1.0f));
  return wasm_f32x4_mul(p, power);
}

[[maybe_unused]] inline Vec sigmoid(Vec x) {
  const Vec one = splat(1.0f);
  return wasm_f32x4_div(one, wasm_f32x4_add(one, exp(wasm_f32x4_neg(x))));
}

// 1 - 2 / (exp(2x) + 1), or near zero, because of cancellation, x - x^3/3 + 2x^5/15 - 17x^7/315.
[[maybe_unused]] inline Vec tanh(Vec x) {
  const Vec one = splat(1.0f);
  const Vec denominator = wasm_f32x4_add(exp(wasm_f32x4_add(x, x)), one);
  const Vec large = wasm_f32x4_sub(one, wasm_f32x4_div(splat(2.0f), denominator));
  const Vec s = wasm_f32x4_mul(x, x);
  Vec p = splat(62.0f / 2835.0f);
  p = add_product(splat(-17.0f / 315.0f), p, s);
  p = add_product(splat(2.0f / 15.0f), p, s);
  p = add_product(splat(-1.0f / 3.0f), p, s);
  const Vec small = add_product(x, wasm_f32x4_mul(p, s), x);
  return wasm_v128_bitselect(small, large, wasm_f32x4_lt(wasm_f32x4_abs(x), splat(0.2f)));
}

// Applies an activation other than a clamp to four channels from `first` on.
inline Vec curved(Vec x, const ActivationSpec& activation, std::int32_t first,
                  std::int32_t channels) {
  const Vec positive = wasm_f32x4_gt(x, splat(0.0f));
  switch (activation.kind) {
    case Activation::kLeakyRelu:
      return wasm_v128_bitselect(x, wasm_f32x4_mul(x, splat(activation.alpha)), positive);
    case Activation::kPrelu:
      return wasm_v128_bitselect(x, wasm_f32x4_mul(x, load_half(activation.slopes + first)),
                                 positive);
    case Activation::kSigmoid:  // the only one that maps 0 in unused lanes to another value
      return only(lane_mask(first, channels), sigmoid(x));
    case Activation::kTanh:
      return tanh(x);
    default:
      return x;
  }
}

// In place on [pixels][4], pixels `step` floats apart. Not inlined: it is large, and the caller's
// sums would not stay in registers.
[[maybe_unused, gnu::noinline]] inline void curve(float* values, std::ptrdiff_t pixels,
                                                  std::ptrdiff_t step,
                                                  const ActivationSpec& activation,
                                                  std::int32_t first, std::int32_t channels) {
  for (std::ptrdiff_t p = 0; p < pixels; ++p, values += step) {
    store(values, curved(load(values), activation, first, channels));
  }
}

// A prepared activation: a range for clamps, otherwise an infinite range and a curve.
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

  [[nodiscard]] Vec clamped(Vec x) const { return min(max(x, low_), high_); }

  // Applies the curve, if any, to clamped values in place: of a block, or as `curve` does.
  void curve_block(float* values, std::ptrdiff_t pixels, std::int32_t block) const {
    curve_channels(values, pixels, block * kBlock);
    curve_channels(values + kLanes, pixels, block * kBlock + kLanes);
  }
  void curve_channels(float* values, std::ptrdiff_t pixels, std::int32_t first) const {
    if (curves_) {
      curve(values, pixels, kBlock, activation_, first, channels_);
    }
  }

 private:
  const ActivationSpec& activation_;
  std::int32_t channels_;
  Vec low_, high_;
  bool curves_;
};

}  // namespace
}  // namespace mien::kernels::wasm
