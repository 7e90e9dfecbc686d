// Conversion of floats to integers of 16 bits for the WebAssembly kernels.
#pragma once

#include "kernels/common/wasm.h"

namespace mien::kernels::wasm {
namespace {

// Rounds to the nearest integer, half to even, for magnitudes of at most 2^22: adding 1.5 * 2^23
// leaves the integer in the low bits of the mantissa. This takes two instructions on every CPU,
// wasm_i32x4_trunc_sat_f32x4 many more on x86.
[[maybe_unused]] inline Vec rounded(Vec x) {
  constexpr float kShift = 0x1.8p23f;
  return wasm_i32x4_sub(wasm_f32x4_add(x, splat(kShift)), splat(kShift));
}

// 8 floats of magnitudes up to 2^22 to integers of 16 bits; larger ones than 32767 saturate.
[[maybe_unused]] inline Vec fixed(Vec low, Vec high) {
  return wasm_i16x8_narrow_i32x4(rounded(low), rounded(high));
}

}  // namespace
}  // namespace mien::kernels::wasm
