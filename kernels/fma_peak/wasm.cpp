// The wasm tier of fma_peak.
#include "kernels/common/wasm.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {

// Multiplies, then adds: SIMD128 has no fused multiply-add.
void fma_peak(const FmaPeakArgs& a) {
  constexpr int kSums = 12;  // throughput 1 per cycle, latency up to 9 cycles, and spare
  Vec sum[kSums];
  for (int k = 0; k < kSums; ++k) {
    sum[k] = splat(static_cast<float>(k));
  }
  const Vec factor = splat(0.999f), term = splat(0.001f);
  for (std::int64_t i = 0; i < a.rounds; ++i) {
    for (Vec& one : sum) {
      one = add_product(term, one, factor);
    }
  }
  Vec total = splat(0.0f);
  for (const Vec& one : sum) {
    total = wasm_f32x4_add(total, one);
  }
  store(a.y, total);
  store(a.y + kLanes, total);
  *a.macs = a.rounds * kSums * kLanes;
}

}  // namespace mien::kernels::wasm
