// The wasm tier of global_average_pool.
#include "kernels/common/wasm.h"
#include "kernels/families.h"
#include "kernels/global_average_pool/parts.h"

namespace mien::kernels::wasm {
namespace {

// Four sums hide the latency of additions.
Vec sum_of_four(const float* x, std::int32_t pixels) {
  constexpr int kSums = 4;
  Vec sums[kSums];
  for (Vec& one : sums) {
    one = splat(0.0f);
  }
  std::int32_t p = 0;
  for (; p + kSums <= pixels; p += kSums, x += kSums * kBlock) {
    for (int i = 0; i < kSums; ++i) {
      sums[i] = wasm_f32x4_add(sums[i], load(x + i * kBlock));
    }
  }
  for (; p < pixels; ++p, x += kBlock) {
    sums[0] = wasm_f32x4_add(sums[0], load(x));
  }
  return wasm_f32x4_add(wasm_f32x4_add(sums[0], sums[1]), wasm_f32x4_add(sums[2], sums[3]));
}

void sum_of_part(const float* x, std::int32_t pixels, float (&part)[8]) {
  store(part, sum_of_four(x, pixels));
  store(part + kLanes, sum_of_four(x + kLanes, pixels));
}

}  // namespace

void global_average_pool(const GlobalAveragePoolArgs& a) { mean_by_parts(a, sum_of_part); }

}  // namespace mien::kernels::wasm
