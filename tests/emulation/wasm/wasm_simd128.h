// WebAssembly's SIMD in scalar code, for kernels that a test compiles for other machines: SIMDe.
#pragma once

#define SIMDE_NO_NATIVE
#define SIMDE_ENABLE_NATIVE_ALIASES
#include <simde/wasm/simd128.h>

#include <cmath>
#include <cstdint>
#include <cstring>

// WebAssembly never flushes denormal numbers, unlike the engine on other machines, and its kernels
// depend on that when they convert fp16 with a product. Reads a denormal factor from its bits.
inline double emulated_exact(float x) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  if ((bits & 0x7F800000u) != 0) {
    return double{x};
  }
  const double magnitude = static_cast<double>(bits & 0x7FFFFFu) * 0x1p-149;
  return (bits >> 31) != 0 ? -magnitude : magnitude;
}
#undef wasm_f32x4_mul
inline simde_v128_t wasm_f32x4_mul(simde_v128_t a, simde_v128_t b) {
  float x[4], w[4], y[4];
  std::memcpy(x, &a, sizeof x);
  std::memcpy(w, &b, sizeof w);
  for (int i = 0; i < 4; ++i) {
    y[i] = static_cast<float>(emulated_exact(x[i]) * emulated_exact(w[i]));
  }
  simde_v128_t product;
  std::memcpy(&product, y, sizeof product);
  return product;
}
