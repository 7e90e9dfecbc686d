// As many channels at a time as a vector of the processor holds: maps are [pixels][channels],
// stored as fp32 or bfloat16 and computed with in fp32.
#pragma once

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

// The upper half of a float; its own type, so that loads and stores know what they meet.
struct BFloat16 {
  std::uint16_t bits;
};

inline Lanes load(const float* from) {
  Lanes out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

inline Lanes load(const BFloat16* from) {
  Halves halves;
  std::memcpy(&halves, from, sizeof halves);
  return std::bit_cast<Lanes>(__builtin_convertvector(halves, Words) << 16);
}

inline void store(float* to, Lanes value) { std::memcpy(to, &value, sizeof value); }

// To the nearest, ties to even.
inline void store(BFloat16* to, Lanes value) {
  const Words bits = std::bit_cast<Words>(value);
  const Halves halves =
      __builtin_convertvector((bits + 0x7fffu + ((bits >> 16) & 1u)) >> 16, Halves);
  std::memcpy(to, &halves, sizeof halves);
}

// The first `count` channels only; the rest are 0, or are left alone.
template <typename T>
Lanes load_some(const T* from, std::size_t count) {
  if (count >= kLanes) {
    return load(from);
  }
  T whole[kLanes] = {};
  std::memcpy(whole, from, count * sizeof(T));
  return load(whole);
}

template <typename T>
void store_some(T* to, Lanes value, std::size_t count) {
  if (count >= kLanes) {
    return store(to, value);
  }
  T whole[kLanes];
  store(whole, value);
  std::memcpy(to, whole, count * sizeof(T));
}

// Asks for values that are soon wanted in another order than memory has them.
template <typename T>
void prefetch(const T* from, std::size_t count) {
  for (std::size_t i = 0; i < count; i += 64 / sizeof(T)) {
    __builtin_prefetch(from + i, 0, 2);
  }
}

inline Lanes smaller(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }

}  // namespace mien::training
