// The wasm tier of quantize_weights. It computes 4 outputs at once.
#include "kernels/common/wasm_fixed.h"
#include "kernels/families.h"
#include "kernels/quantize_weights/quantized_scale.h"

namespace mien::kernels::wasm {
namespace {

// The fp16 weights of 4 outputs of a panel.
struct Outputs {
  const std::uint16_t* weights;
  std::int32_t width;  // of the panel: 16 or 8
  std::int32_t inputs;
  [[nodiscard]] Vec at(std::int32_t k) const {
    return load_half(weights + std::ptrdiff_t{k} * width);
  }
};

Vec scales_of(const QuantizeWeightsArgs& a, const Outputs& outputs) {
  const Vec zero = splat(0.0f);
  Vec above = zero, below = zero, largest = zero;
  for (std::int32_t k = 0; k < outputs.inputs; ++k) {
    const Vec w = outputs.at(k);
    above = wasm_f32x4_add(above, max(w, zero));
    below = wasm_f32x4_sub(below, min(w, zero));
    largest = max(largest, wasm_f32x4_abs(w));
  }
  const Vec reach = a.is_signed ? wasm_f32x4_add(above, below) : max(above, below);
  return max(wasm_f32x4_mul(reach, splat(scale_of_reach(a))),
             wasm_f32x4_mul(largest, splat(kScaleOfLargest)));
}

Vec inverse(Vec scales) {  // 0 of 0
  return only(wasm_f32x4_gt(scales, splat(0.0f)), wasm_f32x4_div(splat(1.0f), scales));
}

// Quantized elements k and k + 1 of the sum, for each output.
Vec pair_at(const Outputs& outputs, std::int32_t k, Vec inverse_scale) {
  const Vec first = rounded(wasm_f32x4_mul(outputs.at(k), inverse_scale));
  const Vec second = rounded(wasm_f32x4_mul(outputs.at(k + 1), inverse_scale));
  return wasm_v128_or(wasm_v128_and(first, wasm_i32x4_splat(0xFFFF)), wasm_i32x4_shl(second, 16));
}

void write_pairs(const Outputs& outputs, Vec inverse_scale, std::int16_t* y) {
  if (outputs.width == kPanel) {
    for (std::int32_t k = 0; k < outputs.inputs; k += 2, y += 2 * kPanel) {
      wasm_v128_store(y, pair_at(outputs, k, inverse_scale));
    }
    return;
  }
  for (std::int32_t k = 0; k < outputs.inputs; k += 4, y += 2 * kPanel) {
    const Vec first = pair_at(outputs, k, inverse_scale);
    const Vec second = pair_at(outputs, k + 2, inverse_scale);
    wasm_v128_store(y, wasm_i32x4_shuffle(first, second, 0, 4, 1, 5));
    wasm_v128_store(y + kBlock, wasm_i32x4_shuffle(first, second, 2, 6, 3, 7));
  }
}

}  // namespace

void quantize_weights(const QuantizeWeightsArgs& a) {
  const std::int32_t inputs = a.in_blocks * kBlock, outputs = a.out_blocks * kBlock;
  for (std::int32_t channel = 0; channel < outputs; channel += kLanes) {
    const std::int32_t first = channel / kPanel * kPanel;  // output of the panel
    const std::int32_t width = outputs - first < kPanel ? kBlock : kPanel;
    const std::ptrdiff_t panel = std::ptrdiff_t{first} * inputs;
    const std::int32_t lane = channel - first, together = width == kPanel ? 2 : 4;
    const Outputs four{a.weights + panel + lane, width, inputs};
    const Vec scales = scales_of(a, four);
    store(a.scales + channel, scales);
    write_pairs(four, inverse(scales), a.pairs + panel + lane * together);
  }
}

}  // namespace mien::kernels::wasm
