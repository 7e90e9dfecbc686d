// x86 vector instructions in scalar code, for kernels that a test compiles for other machines:
// SIMDe, and below the AVX-512 and AVX-512 FP16 intrinsics that SIMDe 0.7.4 lacks. Names and
// semantics are those of the Intel Intrinsics Guide.
#pragma once

#define SIMDE_NO_NATIVE
#define SIMDE_ENABLE_NATIVE_ALIASES
#include <simde/simde-f16.h>
#include <simde/x86/avx2.h>
#include <simde/x86/avx512.h>
#include <simde/x86/f16c.h>
#include <simde/x86/fma.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#ifndef _MM_FROUND_NO_EXC
#define _MM_FROUND_NO_EXC SIMDE_MM_FROUND_NO_EXC
#endif
#ifndef _MM_FROUND_TO_NEAREST_INT
#define _MM_FROUND_TO_NEAREST_INT SIMDE_MM_FROUND_TO_NEAREST_INT
#endif
#define __mmask16 simde__mmask16
#define __mmask32 simde__mmask32
// SIMDe defines the masked variants of this name as macros with four arguments.
#ifdef _mm512_madd_epi16
#undef _mm512_madd_epi16
#define _mm512_madd_epi16(a, b) simde_mm512_madd_epi16(a, b)
#endif

// Converts a vector to an array of lanes, and back.
template <class T, class V>
struct EmulatedLanes {
  static constexpr int kCount = static_cast<int>(sizeof(V) / sizeof(T));
  T at[kCount];
  explicit EmulatedLanes(V v) { std::memcpy(at, &v, sizeof v); }
  EmulatedLanes() : at{} {}
  V vector() const {
    V v;
    std::memcpy(&v, at, sizeof v);
    return v;
  }
};

// To[i] = f(From[i]) for the lanes that both vectors have.
template <class To, class ToVec, class From, class FromVec, class Function>
ToVec emulated_map(FromVec x, Function f) {
  const EmulatedLanes<From, FromVec> from(x);
  EmulatedLanes<To, ToVec> to;
  for (int i = 0; i < to.kCount && i < from.kCount; ++i) {
    to.at[i] = static_cast<To>(f(from.at[i]));
  }
  return to.vector();
}

// Copies the lanes in the mask; the others become 0 and are not read.
template <class T, class V>
V emulated_masked_load(std::uint64_t mask, const void* from) {
  EmulatedLanes<T, V> lanes;
  for (int i = 0; i < lanes.kCount; ++i) {
    if ((mask >> i & 1u) != 0) {
      std::memcpy(&lanes.at[i], static_cast<const T*>(from) + i, sizeof(T));
    }
  }
  return lanes.vector();
}
template <class T, class V>
void emulated_masked_store(void* to, std::uint64_t mask, V x) {
  const EmulatedLanes<T, V> lanes(x);
  for (int i = 0; i < lanes.kCount; ++i) {
    if ((mask >> i & 1u) != 0) {
      std::memcpy(static_cast<T*>(to) + i, &lanes.at[i], sizeof(T));
    }
  }
}

inline float emulated_half_to_float(std::uint16_t x) {
  return simde_float16_to_float32(simde_uint16_as_float16(x));
}
inline std::uint16_t emulated_float_to_half(float x) {
  return simde_float16_as_uint16(simde_float16_from_float32(x));
}

inline float _cvtsh_ss(std::uint16_t x) { return emulated_half_to_float(x); }
inline std::uint16_t _cvtss_sh(float x, int) { return emulated_float_to_half(x); }

// AVX-VNNI.
inline simde__m256i _mm256_dpwssd_avx_epi32(simde__m256i sum, simde__m256i x, simde__m256i y) {
  return simde_mm256_add_epi32(sum, simde_mm256_madd_epi16(x, y));
}

inline simde__m256i _mm256_dpbusd_avx_epi32(simde__m256i sum, simde__m256i x, simde__m256i y) {
  return simde_mm256_dpbusd_epi32(sum, x, y);
}

// AVX-512 F, BW and DQ.
inline simde__m512 _mm512_maskz_loadu_ps(std::uint16_t mask, const void* from) {
  return emulated_masked_load<float, simde__m512>(mask, from);
}
inline void _mm512_mask_storeu_ps(void* to, std::uint16_t mask, simde__m512 x) {
  emulated_masked_store<float>(to, mask, x);
}
inline simde__m256i _mm256_maskz_loadu_epi16(std::uint16_t mask, const void* from) {
  return emulated_masked_load<std::uint16_t, simde__m256i>(mask, from);
}
inline void _mm256_mask_storeu_epi16(void* to, std::uint16_t mask, simde__m256i x) {
  emulated_masked_store<std::uint16_t>(to, mask, x);
}
inline simde__m512 _mm512_cvtph_ps(simde__m256i x) {
  return emulated_map<float, simde__m512, std::uint16_t>(x, emulated_half_to_float);
}
inline simde__m512 _mm512_cvtepi32_ps(simde__m512i x) {
  return emulated_map<float, simde__m512, std::int32_t>(
      x, [](std::int32_t one) { return static_cast<float>(one); });
}
// Rounds to nearest even; values outside the range of an integer become the minimum.
inline simde__m512i _mm512_cvtps_epi32(simde__m512 x) {
  return emulated_map<std::int32_t, simde__m512i, float>(x, [](float one) {
    const bool fits = one >= -0x1p31f && one < 0x1p31f;
    return fits ? static_cast<std::int32_t>(std::nearbyint(one)) : INT32_MIN;
  });
}
inline simde__m256i _mm512_cvtepi32_epi16(simde__m512i x) {
  return emulated_map<std::uint16_t, simde__m256i, std::uint32_t>(
      x, [](std::uint32_t one) { return one & 0xFFFFu; });
}
inline simde__m128i _mm512_cvtepi32_epi8(simde__m512i x) {
  return emulated_map<std::uint8_t, simde__m128i, std::uint32_t>(
      x, [](std::uint32_t one) { return one & 0xFFu; });
}
inline simde__m512i _mm512_cvtepu8_epi16(simde__m256i x) {
  return emulated_map<std::uint16_t, simde__m512i, std::uint8_t>(
      x, [](std::uint8_t one) { return one; });
}
inline int _mm512_cvtsi512_si32(simde__m512i x) {
  return EmulatedLanes<int, simde__m512i>(x).at[0];
}
inline simde__m256 _mm512_extractf32x8_ps(simde__m512 x, int half) {
  EmulatedLanes<float, simde__m256> lanes;
  std::memcpy(lanes.at, EmulatedLanes<float, simde__m512>(x).at + 8 * half, sizeof lanes.at);
  return lanes.vector();
}
inline simde__m512 _mm512_zextps256_ps512(simde__m256 x) {
  return emulated_map<float, simde__m512, float>(x, [](float one) { return one; });
}
inline simde__m512 _mm512_permute_ps(simde__m512 x, int order) {
  const EmulatedLanes<float, simde__m512> from(x);
  EmulatedLanes<float, simde__m512> to;
  for (int i = 0; i < to.kCount; ++i) {
    to.at[i] = from.at[i / 4 * 4 + (order >> i % 4 * 2 & 3)];
  }
  return to.vector();
}
inline float _mm512_reduce_max_ps(simde__m512 x) {
  const EmulatedLanes<float, simde__m512> lanes(x);
  float largest = lanes.at[0];
  for (const float one : lanes.at) {
    largest = one > largest ? one : largest;
  }
  return largest;
}
inline simde__m512i _mm512_i32gather_epi32(simde__m512i index, const void* base, int scale) {
  return emulated_map<std::int32_t, simde__m512i, std::int32_t>(index, [&](std::int32_t one) {
    std::int32_t value;
    std::memcpy(&value, static_cast<const char*>(base) + std::int64_t{one} * scale, sizeof value);
    return value;
  });
}

// Replaces SIMDe 0.7.4: two of its functions are wrong, and its masked load reads lanes outside the
// mask.
#undef _mm512_abs_ps
inline simde__m512 _mm512_abs_ps(simde__m512 x) {
  return emulated_map<float, simde__m512, float>(x, [](float one) { return std::fabs(one); });
}
#undef _mm512_roundscale_ps
inline simde__m512 _mm512_roundscale_ps(simde__m512 x, int rounding) {
  const bool down = (rounding & 7) == SIMDE_MM_FROUND_TO_NEG_INF;
  return emulated_map<float, simde__m512, float>(
      x, [down](float one) { return down ? std::floor(one) : std::nearbyint(one); });
}
#undef _mm256_maskload_ps
inline simde__m256 _mm256_maskload_ps(const float* from, simde__m256i mask) {
  const EmulatedLanes<std::int32_t, simde__m256i> signs(mask);
  std::uint64_t bits = 0;
  for (int i = 0; i < signs.kCount; ++i) {
    bits |= std::uint64_t{signs.at[i] < 0} << i;
  }
  return emulated_masked_load<float, simde__m256>(bits, from);
}

// AVX-512 FP16: vectors of fp16 values, stored as bits.
struct EmulatedHalf {
  std::uint16_t bits;
  explicit EmulatedHalf(float x) : bits(emulated_float_to_half(x)) {}
};
#define _Float16 EmulatedHalf

template <int kCount>
struct EmulatedHalves {
  std::uint16_t at[kCount];
};
using __m512h = EmulatedHalves<32>;
using __m256h = EmulatedHalves<16>;

// Products and sums of two fp16 values are almost exact in double, so results are rounded once.
template <class Vec, class Function>
Vec emulated_halves(Vec a, Vec b, Vec c, Function f) {
  Vec y;
  for (std::size_t i = 0; i < sizeof y.at / sizeof y.at[0]; ++i) {
    const double x = emulated_half_to_float(a.at[i]), w = emulated_half_to_float(b.at[i]);
    y.at[i] = emulated_float_to_half(
        static_cast<float>(f(x, w, double{emulated_half_to_float(c.at[i])})));
  }
  return y;
}
template <class To, class From>
To emulated_bits(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

inline __m512h _mm512_castsi512_ph(simde__m512i x) { return emulated_bits<__m512h>(x); }
inline simde__m512i _mm512_castph_si512(__m512h x) { return emulated_bits<simde__m512i>(x); }
inline simde__m256i _mm256_castph_si256(__m256h x) { return emulated_bits<simde__m256i>(x); }
inline __m512h _mm512_setzero_ph() { return {}; }
inline __m256h _mm256_setzero_ph() { return {}; }
inline __m512h _mm512_set1_ph(EmulatedHalf x) {
  __m512h y;
  for (std::uint16_t& one : y.at) {
    one = x.bits;
  }
  return y;
}
inline __m512h _mm512_loadu_ph(const void* from) {
  __m512h x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
inline __m256h _mm256_loadu_ph(const void* from) {
  __m256h x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
inline void _mm512_storeu_ph(void* to, __m512h x) { std::memcpy(to, &x, sizeof x); }
inline __m512h _mm512_fmadd_ph(__m512h a, __m512h b, __m512h c) {
  return emulated_halves(a, b, c, [](double x, double w, double sum) { return x * w + sum; });
}
inline __m512h _mm512_add_ph(__m512h a, __m512h b) {
  return emulated_halves(a, b, a, [](double x, double y, double) { return x + y; });
}
// As in SSE, returns the second operand if one is NaN or both are zero.
inline __m512h _mm512_min_ph(__m512h a, __m512h b) {
  return emulated_halves(a, b, a, [](double x, double y, double) { return x < y ? x : y; });
}
inline __m512h _mm512_max_ph(__m512h a, __m512h b) {
  return emulated_halves(a, b, a, [](double x, double y, double) { return x > y ? x : y; });
}
inline simde__m512 _mm512_cvtxph_ps(__m256h x) {
  return emulated_map<float, simde__m512, std::uint16_t>(x, emulated_half_to_float);
}
inline __m256h _mm512_cvtxps_ph(simde__m512 x) {
  return emulated_map<std::uint16_t, __m256h, float>(x, emulated_float_to_half);
}
