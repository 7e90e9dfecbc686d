// There is no instruction for it: fields are moved and compared as integers.
#include <cstring>

#include "kernels/common/wasm.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

constexpr std::int32_t kInfinity = 0x7F800000;          // bits of the float
constexpr std::int32_t kHalfInfinity = 0x7C00;          // bits of the half
constexpr std::int32_t kRoundsToInfinity = 0x477FF000;  // 65520
constexpr std::int32_t kSmallestNormal = 0x38800000;    // 2^-14

Vec integers(std::int32_t x) { return wasm_i32x4_splat(x); }

// Not-a-numbers and infinities as well: their exponent is all ones in both formats.
Vec to_float(const std::uint16_t* at) {
  const Vec exponent = wasm_v128_and(wasm_u32x4_load16x4(at), integers(kHalfInfinity));
  const Vec not_finite = wasm_i32x4_eq(exponent, integers(kHalfInfinity));
  return wasm_v128_or(load_half(at), wasm_v128_and(not_finite, integers(kInfinity)));
}

// The exponent moves from bias 127 to 15, and 13 bits are rounded away.
Vec normal_half(Vec magnitude) {
  const Vec odd = wasm_v128_and(wasm_u32x4_shr(magnitude, 13), integers(1));
  const Vec rounding = wasm_i32x4_add(odd, integers(0xFFF - (112 << 23)));
  return wasm_u32x4_shr(wasm_i32x4_add(magnitude, rounding), 13);
}

// Next to 1/2 floats are multiples of 2^-24, as denormal halves are.
Vec denormal_half(Vec magnitude) {
  const Vec half = splat(0.5f);
  return wasm_i32x4_sub(wasm_f32x4_add(magnitude, half), half);
}

// Quiet, with what fits of its payload.
Vec not_a_number(Vec magnitude) {
  const Vec payload = wasm_v128_and(wasm_u32x4_shr(magnitude, 13), integers(0x3FF));
  return wasm_v128_or(payload, integers(0x7E00));
}

// In the lower half of each lane.
Vec to_half(Vec x) {
  const Vec magnitude = wasm_v128_and(x, integers(0x7FFFFFFF));
  Vec half = wasm_v128_bitselect(normal_half(magnitude), denormal_half(magnitude),
                                 wasm_i32x4_ge(magnitude, integers(kSmallestNormal)));
  half = wasm_v128_bitselect(integers(kHalfInfinity), half,
                             wasm_i32x4_ge(magnitude, integers(kRoundsToInfinity)));
  half = wasm_v128_bitselect(not_a_number(magnitude), half,
                             wasm_i32x4_gt(magnitude, integers(kInfinity)));
  const Vec sign = wasm_v128_and(wasm_u32x4_shr(x, 16), integers(0x8000));
  return wasm_v128_or(half, sign);
}

}  // namespace

void half_to_float(const HalfToFloatArgs& a) {
  std::int32_t i = 0;
  for (; i + kLanes <= a.n; i += kLanes) {
    store(a.y + i, to_float(a.x + i));
  }
  std::uint16_t rest[kLanes] = {};
  float wide[kLanes];
  const auto left = static_cast<std::size_t>(a.n - i);
  std::memcpy(rest, a.x + i, left * sizeof rest[0]);
  store(wide, to_float(rest));
  std::memcpy(a.y + i, wide, left * sizeof wide[0]);
}

void float_to_half(const FloatToHalfArgs& a) {
  std::int32_t i = 0;
  for (; i + kLanes <= a.n; i += kLanes) {
    const Vec halves = to_half(load(a.x + i));
    wasm_v128_store64_lane(a.y + i, wasm_u16x8_narrow_i32x4(halves, halves), 0);
  }
  float rest[kLanes] = {};
  std::uint16_t narrow[2 * kLanes];
  const auto left = static_cast<std::size_t>(a.n - i);
  std::memcpy(rest, a.x + i, left * sizeof rest[0]);
  const Vec halves = to_half(load(rest));
  wasm_v128_store(narrow, wasm_u16x8_narrow_i32x4(halves, halves));
  std::memcpy(a.y + i, narrow, left * sizeof narrow[0]);
}

}  // namespace mien::kernels::wasm
