// NEON in scalar code, for kernels that a test compiles for other machines: SIMDe, and below the
// intrinsics that SIMDe 0.7.4 lacks. Names and semantics are those of the Arm Neon Intrinsics
// Reference.
#pragma once

#define SIMDE_NO_NATIVE
#define SIMDE_ENABLE_NATIVE_ALIASES
#include <simde/arm/neon.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

inline float emulated_to_float(simde_float16 x) { return simde_float16_to_float32(x); }
inline simde_float16 emulated_to_half(double x) {
  return simde_float16_from_float32(static_cast<float>(x));
}

// SIMDe's own type is a struct of bits without conversions from numbers.
#ifdef float16_t
#undef float16_t
#endif
#define float16_t EmulatedHalf
struct EmulatedHalf {
  simde_float16 value;
  explicit EmulatedHalf(float x) : value(emulated_to_half(double{x})) {}
};

// Converts a vector to an array of lanes, and back.
template <class T, class V>
struct EmulatedLanes {
  static constexpr int kCount = static_cast<int>(sizeof(V) / sizeof(T));
  T at[kCount];
  EmulatedLanes() = default;
  explicit EmulatedLanes(V v) { std::memcpy(at, &v, sizeof v); }
  V vector() const {
    V v;
    std::memcpy(&v, at, sizeof v);
    return v;
  }
};
using EmulatedHalves = EmulatedLanes<simde_float16, float16x8_t>;
using EmulatedFloats = EmulatedLanes<float, float32x4_t>;

// f(a[i], b[i], c[i]) for floats.
template <class Function>
float32x4_t emulated_floats(float32x4_t a, float32x4_t b, float32x4_t c, Function f) {
  const EmulatedFloats x(a), w(b), s(c);
  EmulatedFloats y;
  for (int i = 0; i < y.kCount; ++i) {
    y.at[i] = f(x.at[i], w.at[i], s.at[i]);
  }
  return y.vector();
}
// The same for fp16: products and sums of two are almost exact in double, so results are rounded
// once.
template <class Function>
float16x8_t emulated_halves(float16x8_t a, float16x8_t b, float16x8_t c, Function f) {
  const EmulatedHalves x(a), w(b), s(c);
  EmulatedHalves y;
  for (int i = 0; i < y.kCount; ++i) {
    y.at[i] =
        emulated_to_half(f(double{emulated_to_float(x.at[i])}, double{emulated_to_float(w.at[i])},
                           double{emulated_to_float(s.at[i])}));
  }
  return y.vector();
}
inline float16x8_t emulated_broadcast(float16x8_t x, int lane) {
  const EmulatedHalves from(x);
  EmulatedHalves to;
  for (simde_float16& one : to.at) {
    one = from.at[lane];
  }
  return to.vector();
}

inline float32x4_t vdivq_f32(float32x4_t a, float32x4_t b) {
  return emulated_floats(a, b, a, [](float x, float y, float) { return x / y; });
}
inline float32x4_t vsqrtq_f32(float32x4_t a) {
  return emulated_floats(a, a, a, [](float x, float, float) { return std::sqrt(x); });
}
inline float32x4_t vfmsq_f32(float32x4_t sum, float32x4_t a, float32x4_t b) {
  return emulated_floats(a, b, sum, [](float x, float w, float s) { return std::fma(-x, w, s); });
}
// Replaces SIMDe's functions: the estimate of a reciprocal has 8 bits, and the Newton step treats
// zero times infinity as zero (Arm Architecture Reference Manual, FPRecipEstimate and
// FPRecipStepFused).
#undef vrecpeq_f32
inline float32x4_t vrecpeq_f32(float32x4_t a) {
  return emulated_floats(a, a, a, [](float x, float, float) {
    int exponent = 0;
    const float estimate = 1.0f / std::frexp(x, &exponent);
    const bool is_finite = std::isfinite(estimate) && x != 0.0f;
    return is_finite ? std::ldexp(std::nearbyint(estimate * 0x1p8f) * 0x1p-8f, -exponent)
                     : 1.0f / x;
  });
}
#undef vrecpsq_f32
inline float32x4_t vrecpsq_f32(float32x4_t a, float32x4_t b) {
  return emulated_floats(a, b, a, [](float x, float y, float) {
    const bool is_zero_times_infinity =
        (std::isinf(x) && y == 0.0f) || (x == 0.0f && std::isinf(y));
    return is_zero_times_infinity ? 2.0f : 2.0f - x * y;
  });
}
// ARMv7: the product is rounded before it is added.
inline float32x4_t vmlaq_lane_f32(float32x4_t sum, float32x4_t a, float32x2_t b, int lane) {
  const float w = EmulatedLanes<float, float32x2_t>(b).at[lane];
  return emulated_floats(a, a, sum, [w](float x, float, float s) {
    const float product = x * w;
    return s + product;
  });
}

// ARMv8.2 with FP16.
#ifdef vdupq_n_f16
#undef vdupq_n_f16
#endif
inline float16x8_t vdupq_n_f16(EmulatedHalf x) {
  EmulatedHalves to;
  for (simde_float16& one : to.at) {
    one = x.value;
  }
  return to.vector();
}
inline float16x8_t vfmaq_f16(float16x8_t sum, float16x8_t a, float16x8_t b) {
  return emulated_halves(a, b, sum, [](double x, double w, double s) { return x * w + s; });
}
inline float16x8_t vfmaq_laneq_f16(float16x8_t sum, float16x8_t a, float16x8_t b, int lane) {
  return vfmaq_f16(sum, a, emulated_broadcast(b, lane));
}
inline float16x8_t vmulq_laneq_f16(float16x8_t a, float16x8_t b, int lane) {
  return emulated_halves(a, emulated_broadcast(b, lane), a,
                         [](double x, double w, double) { return x * w; });
}
inline float16x8_t vnegq_f16(float16x8_t a) {
  return emulated_halves(a, a, a, [](double x, double, double) { return -x; });
}
// These return NaN if one operand is NaN; the next two return the other operand.
inline float16x8_t vmaxq_f16(float16x8_t a, float16x8_t b) {
  return emulated_halves(a, b, a, [](double x, double y, double) {
    return std::isnan(x) || std::isnan(y) ? x + y : std::fmax(x, y);
  });
}
inline float16x8_t vminq_f16(float16x8_t a, float16x8_t b) {
  return emulated_halves(a, b, a, [](double x, double y, double) {
    return std::isnan(x) || std::isnan(y) ? x + y : std::fmin(x, y);
  });
}
inline float16x8_t vmaxnmq_f16(float16x8_t a, float16x8_t b) {
  return emulated_halves(a, b, a, [](double x, double y, double) { return std::fmax(x, y); });
}
inline float16x8_t vminnmq_f16(float16x8_t a, float16x8_t b) {
  return emulated_halves(a, b, a, [](double x, double y, double) { return std::fmin(x, y); });
}
inline float16x4_t vget_low_f16(float16x8_t x) {
  float16x4_t low;
  std::memcpy(&low, EmulatedHalves(x).at, sizeof low);
  return low;
}
inline float32x4_t vcvt_high_f32_f16(float16x8_t x) {
  const EmulatedHalves from(x);
  EmulatedFloats to;
  for (int i = 0; i < to.kCount; ++i) {
    to.at[i] = emulated_to_float(from.at[i + to.kCount]);
  }
  return to.vector();
}
inline float16x8_t vcvt_high_f16_f32(float16x4_t low, float32x4_t high) {
  EmulatedHalves to;
  std::memcpy(to.at, &low, sizeof low);
  const EmulatedFloats from(high);
  for (int i = 0; i < from.kCount; ++i) {
    to.at[i + from.kCount] = emulated_to_half(double{from.at[i]});
  }
  return to.vector();
}
// Rounds to the nearest integer, half to even. NaN becomes 0, other values saturate.
template <class Integer>
Integer emulated_integer(double x) {
  using Limits = std::numeric_limits<Integer>;
  if (std::isnan(x)) {
    return 0;
  }
  const double nearest = std::nearbyint(x);
  return static_cast<Integer>(
      std::fmin(std::fmax(nearest, double{Limits::min()}), double{Limits::max()}));
}
inline uint16x8_t vcvtnq_u16_f16(float16x8_t x) {
  const EmulatedHalves from(x);
  EmulatedLanes<std::uint16_t, uint16x8_t> to;
  for (int i = 0; i < to.kCount; ++i) {
    to.at[i] = emulated_integer<std::uint16_t>(double{emulated_to_float(from.at[i])});
  }
  return to.vector();
}
inline int32x4_t vcvtnq_s32_f32(float32x4_t x) {
  const EmulatedFloats from(x);
  EmulatedLanes<std::int32_t, int32x4_t> to;
  for (int i = 0; i < to.kCount; ++i) {
    to.at[i] = emulated_integer<std::int32_t>(double{from.at[i]});
  }
  return to.vector();
}
inline float16x8_t vmulq_f16(float16x8_t a, float16x8_t b) {
  return emulated_halves(a, b, a, [](double x, double w, double) { return x * w; });
}

// ARMv8.6 with I8MM: a and b are two rows of 8 elements; row i of a times row j of b is added to
// element [i][j].
inline int32x4_t vmmlaq_s32(int32x4_t sum, int8x16_t a, int8x16_t b) {
  const EmulatedLanes<std::int8_t, int8x16_t> rows(a), columns(b);
  EmulatedLanes<std::int32_t, int32x4_t> to(sum);
  for (int i = 0; i < to.kCount; ++i) {
    for (int k = 0; k < 8; ++k) {
      to.at[i] += rows.at[i / 2 * 8 + k] * columns.at[i % 2 * 8 + k];
    }
  }
  return to.vector();
}
