// The wasmint16 tier of fma_peak.
#include "kernels/common/wasm.h"
#include "kernels/families.h"
#include "kernels/fma_peak/integer_peak.h"

namespace mien::kernels::wasmint16 {
namespace {

struct IntegerVector {
  using Sum = wasm::Vec;
  static constexpr int kSums = 12;
  static constexpr int kProducts = 2 * wasm::kLanes;

  static Sum all(int value) { return wasm_i32x4_splat(value); }
  static Sum add(Sum a, Sum b) { return wasm_i32x4_add(a, b); }
  static Sum bit_and(Sum a, Sum b) { return wasm_v128_and(a, b); }
  static Sum bit_or(Sum a, Sum b) { return wasm_v128_or(a, b); }
  static Sum multiply_add(Sum sum, Sum value, Sum weight) {
    return add(sum, wasm_i32x4_dot_i16x8(value, weight));
  }
  static void store(Sum sum, float* y) {
    wasm::store(y, wasm_f32x4_convert_i32x4(sum));
    wasm::store(y + wasm::kLanes, wasm_f32x4_convert_i32x4(sum));
  }
};

}  // namespace

void fma_peak(const FmaPeakArgs& a) { integer_peak<IntegerVector>(a); }

}  // namespace mien::kernels::wasmint16
