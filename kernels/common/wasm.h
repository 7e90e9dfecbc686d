// Helpers shared by the WebAssembly kernels: vectors of 4 floats (SIMD128), no fused multiply-add,
// no fp16 conversion. All have internal linkage, so that the linker cannot merge code of different
// tiers.
#pragma once

#include <wasm_simd128.h>

#include <cstddef>
#include <cstdint>

#include "kernels/activation/activation.h"

namespace mien::kernels::wasm {

constexpr std::int32_t kLanes = 4;   // floats of a vector
constexpr std::int32_t kBlock = 8;   // channels of a block of a map
constexpr std::int32_t kPanel = 16;  // output channels of a panel of weights

namespace {

using Vec = v128_t;
using Mask = v128_t;

// A block of 8 channels.
struct Pair {
  Vec low, high;
};

[[maybe_unused]] inline Vec splat(float x) { return wasm_f32x4_splat(x); }
[[maybe_unused]] inline Vec load(const float* at) { return wasm_v128_load(at); }
[[maybe_unused]] inline Vec load_splat(const float* at) { return wasm_v128_load32_splat(at); }
[[maybe_unused]] inline void store(float* at, Vec x) { wasm_v128_store(at, x); }
[[maybe_unused]] inline Pair load_pair(const float* at) { return {load(at), load(at + kLanes)}; }
// The upper half first: loops of loads and stores are a quarter faster in V8 on x86 than in
// ascending order.
[[maybe_unused]] inline void store_pair(float* at, Pair x) {
  store(at + kLanes, x.high);
  store(at, x.low);
}

[[maybe_unused]] inline Vec add(Vec a, Vec b) { return wasm_f32x4_add(a, b); }
[[maybe_unused]] inline Vec subtract(Vec a, Vec b) { return wasm_f32x4_sub(a, b); }
[[maybe_unused]] inline Vec divide(Vec a, Vec b) { return wasm_f32x4_div(a, b); }

// sum + a * b, rounded twice
[[maybe_unused]] inline Vec add_product(Vec sum, Vec a, Vec b) {
  return wasm_f32x4_add(sum, wasm_f32x4_mul(a, b));
}

// Maximum and minimum; a if one is NaN. WebAssembly's pmax and pmin are one instruction on every
// CPU, unlike its max and min.
[[maybe_unused]] inline Vec max(Vec a, Vec b) { return wasm_f32x4_pmax(a, b); }
[[maybe_unused]] inline Vec min(Vec a, Vec b) { return wasm_f32x4_pmin(a, b); }

// x where the mask is set, 0 elsewhere.
[[maybe_unused]] inline Vec only(Mask mask, Vec x) { return wasm_v128_and(mask, x); }
// x where the mask is set, `other` elsewhere.
[[maybe_unused]] inline Vec choose(Mask mask, Vec x, Vec other) {
  return wasm_v128_bitselect(x, other, mask);
}
// Bitwise or
[[maybe_unused]] inline Vec either(Vec a, Vec b) { return wasm_v128_or(a, b); }

// Loads four finite fp16 values, denormal or not: after the fields of a half move to those of a
// float and the shifted sign bits are cleared from the exponent, the float is too small by the
// difference of the exponent biases, 2^112.
[[maybe_unused]] inline Vec load_half(const std::uint16_t* at) {
  const Vec fields = wasm_i32x4_shl(wasm_i32x4_load16x4(at), 13);
  const Vec small = wasm_v128_and(fields, wasm_i32x4_splat(static_cast<int>(0x8FFFE000u)));
  return wasm_f32x4_mul(small, splat(0x1p112f));
}

[[maybe_unused]] inline std::int32_t blocks_of(std::int32_t channels) {
  return (channels + kBlock - 1) / kBlock;
}

// Mask of the lanes of channels first .. first + 3 that exist.
[[maybe_unused]] inline Mask lane_mask(std::int32_t first, std::int32_t channels) {
  return wasm_i32x4_lt(wasm_i32x4_make(0, 1, 2, 3), wasm_i32x4_splat(channels - first));
}

// combine(lane 0, lane 1, lane 2, lane 3) in all lanes.
template <class Combine>
[[maybe_unused]] inline Vec across(Vec x, Combine combine) {
  x = combine(x, wasm_i32x4_shuffle(x, x, 2, 3, 0, 1));
  return combine(x, wasm_i32x4_shuffle(x, x, 1, 0, 3, 2));
}
[[maybe_unused]] inline Vec sum_of_lanes(Vec x) { return across(x, add); }
[[maybe_unused]] inline Vec largest_lane(Vec x) { return across(x, max); }

}  // namespace
}  // namespace mien::kernels::wasm
