#include "kernels/common/wasm.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

// Four sums hide the latency of additions, and err less on large maps than one would.
Vec sum_of_pixels(const float* x, std::int32_t pixels) {
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

}  // namespace

void global_average_pool(const GlobalAveragePoolArgs& a) {
  const Vec scale = splat(1.0f / static_cast<float>(a.pixels));
  for (std::int32_t first = 0; first < blocks_of(a.channels) * kBlock; first += kLanes) {
    const float* x = a.x + std::ptrdiff_t{first / kBlock} * a.pixels * kBlock + first % kBlock;
    store(a.y + first, wasm_f32x4_mul(sum_of_pixels(x, a.pixels), scale));
  }
}

}  // namespace mien::kernels::wasm
