// A vector register of channels. Maps are [pixels][channels] in fp32 or bfloat16; arithmetic is in
// fp32.
#pragma once

#ifdef __AVX512BF16__
#include <immintrin.h>
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace mien::training {

#ifdef __AVX512F__
constexpr std::size_t kLanes = 16;
#else
constexpr std::size_t kLanes = 8;
#endif
using Lanes = float __attribute__((vector_size(4 * kLanes)));
using Words = std::uint32_t __attribute__((vector_size(4 * kLanes)));
using Halves = std::uint16_t __attribute__((vector_size(2 * kLanes)));

// bfloat16, the upper half of a float. A type of its own selects loads and stores.
struct BFloat16 {
  std::uint16_t bits;
};

inline Lanes load(const float* from) {
  Lanes out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

inline Lanes widened(Halves halves) {
#ifdef __AVX512BF16__  // gcc splits it into halves
  const __m512i words = _mm512_cvtepu16_epi32(std::bit_cast<__m256i>(halves));
  return std::bit_cast<Lanes>(_mm512_slli_epi32(words, 16));
#else
  return std::bit_cast<Lanes>(__builtin_convertvector(halves, Words) << 16);
#endif
}

inline Lanes load(const BFloat16* from) {
  Halves halves;
  std::memcpy(&halves, from, sizeof halves);
  return widened(halves);
}

inline void store(float* to, Lanes value) { std::memcpy(to, &value, sizeof value); }

// Rounds to nearest, ties to even.
inline Halves narrowed(Lanes value) {
#ifdef __AVX512BF16__
  return std::bit_cast<Halves>(_mm512_cvtneps_pbh(std::bit_cast<__m512>(value)));
#else
  const Words bits = std::bit_cast<Words>(value);
  return __builtin_convertvector((bits + 0x7fffu + ((bits >> 16) & 1u)) >> 16, Halves);
#endif
}

inline void store(BFloat16* to, Lanes value) {
  const Halves halves = narrowed(value);
  std::memcpy(to, &halves, sizeof halves);
}

#ifdef __AVX512BF16__
inline __mmask16 first_lanes(std::size_t count) {
  return static_cast<__mmask16>((1u << count) - 1);
}
inline Lanes load_first(const float* from, std::size_t count) {
  return std::bit_cast<Lanes>(_mm512_maskz_loadu_ps(first_lanes(count), from));
}
inline Lanes load_first(const BFloat16* from, std::size_t count) {
  return widened(std::bit_cast<Halves>(_mm256_maskz_loadu_epi16(first_lanes(count), from)));
}
inline void store_first(float* to, Lanes value, std::size_t count) {
  _mm512_mask_storeu_ps(to, first_lanes(count), std::bit_cast<__m512>(value));
}
inline void store_first(BFloat16* to, Lanes value, std::size_t count) {
  _mm256_mask_storeu_epi16(to, first_lanes(count), std::bit_cast<__m256i>(narrowed(value)));
}
#else
template <typename T>
Lanes load_first(const T* from, std::size_t count) {
  T whole[kLanes] = {};
  std::memcpy(whole, from, count * sizeof(T));
  return load(whole);
}

template <typename T>
void store_first(T* to, Lanes value, std::size_t count) {
  T whole[kLanes];
  store(whole, value);
  std::memcpy(to, whole, count * sizeof(T));
}
#endif

// The first `count` channels only. Others are loaded as 0 and not stored.
template <typename T>
Lanes load_some(const T* from, std::size_t count) {
  return count >= kLanes ? load(from) : load_first(from, count);
}

template <typename T>
void store_some(T* to, Lanes value, std::size_t count) {
  count >= kLanes ? store(to, value) : store_first(to, value, count);
}

// Prefetches values that are not read in the order of memory.
template <typename T>
void prefetch(const T* from, std::size_t count) {
  for (std::size_t i = 0; i < count; i += 64 / sizeof(T)) {
    __builtin_prefetch(from + i, 0, 2);
  }
}

inline Lanes smaller(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }

}  // namespace mien::training
