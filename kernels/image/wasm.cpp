// The wasm tier of warp.
#include "kernels/common/wasm.h"
#include "kernels/families.h"
#include "kernels/image/tiles.h"

namespace mien::kernels::wasm {
namespace {

struct Simd {
  static constexpr std::int32_t kLanes = wasm::kLanes;
  using Vec = v128_t;
  using Ints = v128_t;
  using Neighbours = tiles::Gathered<Simd>;

  static Vec splat(float x) { return wasm_f32x4_splat(x); }
  static Vec load(const float* at) { return wasm_v128_load(at); }
  static Vec count_from(float first) {
    return wasm_f32x4_add(splat(first), wasm_f32x4_make(0.0f, 1.0f, 2.0f, 3.0f));
  }
  static Vec fma(Vec sum, Vec a, Vec b) { return add_product(sum, a, b); }
  static Vec sub(Vec a, Vec b) { return wasm_f32x4_sub(a, b); }
  static Vec min(Vec a, Vec b) { return wasm::min(a, b); }
  static Vec max(Vec a, Vec b) { return wasm::max(a, b); }
  static Vec floor(Vec x) { return wasm_f32x4_floor(x); }
  static Ints equal(Vec a, Vec b) { return wasm_f32x4_eq(a, b); }
  // Comparisons with NaN are false.
  static Vec finite_or_0(Vec x) {
    return only(wasm_f32x4_le(wasm_f32x4_abs(x), splat(3.0e38f)), x);
  }
  // Rounds values below 2^22 to the nearest integer: adding 1.5 * 2^23 leaves it in the lowest
  // bits, whereas a conversion takes many instructions on most CPUs.
  static Ints to_ints(Vec x) {
    const Vec shift = splat(12582912.0f);
    return wasm_i32x4_sub(wasm_f32x4_add(x, shift), shift);
  }
  static void store(std::int32_t* at, Ints x) { wasm_v128_store(at, x); }

  // The weight of a sample in the low 16 bits, that of the next sample in the high 16 bits.
  using Weights = v128_t;
  static Weights weights_of(Vec across) {
    const Ints next = to_ints(wasm_f32x4_mul(across, splat(tiles::kOne)));
    const Ints both = wasm_i32x4_sub(wasm_i32x4_shl(next, 16), next);
    return wasm_i32x4_add(both, wasm_i32x4_splat(tiles::kOne));
  }
  static Vec gather(const std::uint16_t* base, Ints index, Weights weights) {
    v128_t pairs = wasm_v128_load32_zero(base + wasm_i32x4_extract_lane(index, 0));
    pairs = wasm_v128_load32_lane(base + wasm_i32x4_extract_lane(index, 1), pairs, 1);
    pairs = wasm_v128_load32_lane(base + wasm_i32x4_extract_lane(index, 2), pairs, 2);
    pairs = wasm_v128_load32_lane(base + wasm_i32x4_extract_lane(index, 3), pairs, 3);
    return wasm_f32x4_convert_i32x4(wasm_i32x4_dot_i16x8(pairs, weights));
  }

  static void store_rgb(float* at, Vec r, Vec g, Vec b) {
    const v128_t rg = wasm_i32x4_shuffle(r, g, 0, 4, 1, 5),
                 rg_high = wasm_i32x4_shuffle(r, g, 2, 6, 3, 7);
    wasm_v128_store(at, wasm_i32x4_shuffle(rg, b, 0, 1, 4, 2));
    const v128_t second = wasm_i32x4_shuffle(rg, b, 3, 5, 3, 5);
    wasm_v128_store(at + 4, wasm_i32x4_shuffle(second, rg_high, 0, 1, 4, 5));
    wasm_v128_store(at + 8, wasm_i32x4_shuffle(rg_high, b, 6, 2, 3, 7));
  }

  static constexpr std::int32_t kSums = 8;
  using Sums = v128_t;

  static Sums load_sums(const std::uint16_t* at) { return wasm_v128_load(at); }
  static void store_sums(std::uint16_t* at, Sums x) { wasm_v128_store(at, x); }
  static Sums add_sums(Sums a, Sums b) { return wasm_i16x8_add(a, b); }

  static Sums bytes(const std::uint8_t* at) { return wasm_u16x8_load8x8(at); }
  static Sums byte_pairs(const std::uint8_t* at) {
    return wasm_u16x8_extadd_pairwise_u8x16(wasm_v128_load(at));
  }
  static Sums even_bytes(const std::uint8_t* at) {
    return wasm_v128_and(wasm_v128_load(at), wasm_i16x8_splat(0xFF));
  }
  static Sums pairs(Sums a, Sums b) {
    return wasm_u16x8_narrow_i32x4(wasm_u32x4_extadd_pairwise_u16x8(a),
                                   wasm_u32x4_extadd_pairwise_u16x8(b));
  }
  static Sums evens(Sums a, Sums b) { return wasm_i16x8_shuffle(a, b, 0, 2, 4, 6, 8, 10, 12, 14); }
};

}  // namespace

void warp(const WarpArgs& a) {
  tiles::Warp<Simd> tiles(a);
  tiles.run();
}

}  // namespace mien::kernels::wasm
