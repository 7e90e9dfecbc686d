// The wasm tier of power_spectrum.
#include "kernels/common/wasm.h"
#include "kernels/families.h"
#include "kernels/power_spectrum/real_transform.h"

namespace mien::kernels::wasm {
namespace {

struct Simd {
  static constexpr std::int32_t kLanes = wasm::kLanes;
  using Vec = v128_t;

  static Vec splat(float x) { return wasm_f32x4_splat(x); }
  static Vec load(const float* at) { return wasm_v128_load(at); }
  static void store(float* at, Vec x) { wasm_v128_store(at, x); }
  static Vec add(Vec a, Vec b) { return wasm_f32x4_add(a, b); }
  static Vec sub(Vec a, Vec b) { return wasm_f32x4_sub(a, b); }
  static Vec mul(Vec a, Vec b) { return wasm_f32x4_mul(a, b); }
  static Vec add_product(Vec sum, Vec a, Vec b) { return wasm::add_product(sum, a, b); }
  static Vec subtract_product(Vec sum, Vec a, Vec b) { return sub(sum, mul(a, b)); }

  static void deinterleave(const float* x, Vec& even, Vec& odd) {
    const Vec a = load(x), b = load(x + kLanes);
    even = wasm_i32x4_shuffle(a, b, 0, 2, 4, 6);
    odd = wasm_i32x4_shuffle(a, b, 1, 3, 5, 7);
  }

  static void transpose(Vec* v) {
    const Vec low0 = wasm_i32x4_shuffle(v[0], v[1], 0, 4, 1, 5);
    const Vec high0 = wasm_i32x4_shuffle(v[0], v[1], 2, 6, 3, 7);
    const Vec low1 = wasm_i32x4_shuffle(v[2], v[3], 0, 4, 1, 5);
    const Vec high1 = wasm_i32x4_shuffle(v[2], v[3], 2, 6, 3, 7);
    v[0] = wasm_i32x4_shuffle(low0, low1, 0, 1, 4, 5);
    v[1] = wasm_i32x4_shuffle(low0, low1, 2, 3, 6, 7);
    v[2] = wasm_i32x4_shuffle(high0, high1, 0, 1, 4, 5);
    v[3] = wasm_i32x4_shuffle(high0, high1, 2, 3, 6, 7);
  }

  static Vec reversed(Vec x) { return wasm_i32x4_shuffle(x, x, 3, 2, 1, 0); }
};

}  // namespace

void power_spectrum(const PowerSpectrumArgs& a) { RealTransform<Simd>(a).power(); }

}  // namespace mien::kernels::wasm
