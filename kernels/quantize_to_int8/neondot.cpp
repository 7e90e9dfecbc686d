// The tiers neondot and neoni8mm of quantize_to_int8. They compute 4 outputs at once.
#include <algorithm>

#include "kernels/common/neon.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// The fp16 weights of 4 outputs of a panel, padded with zeros.
struct Outputs {
  const std::uint16_t* weights;
  std::int32_t width;  // of the panel: 16 or 8
  std::int32_t inputs, reduction;
  std::int32_t together;  // elements of the sum that are stored together: 4 or 8
  [[nodiscard]] Vec at(std::int32_t k) const {
    return k < inputs ? load_half(weights + std::ptrdiff_t{k} * width) : splat(0.0f);
  }
};

Vec scales_of(const Outputs& outputs) {
  Vec largest = splat(0.0f);
  for (std::int32_t k = 0; k < outputs.inputs; ++k) {
    largest = max(largest, vabsq_f32(outputs.at(k)));
  }
  return vmulq_f32(largest, splat(1.0f / kInt8WeightMax));
}

// Quantized elements k .. k + 3 of the sum, for each output; adds them to `sum`.
int32x4_t quad_at(const Outputs& outputs, std::int32_t k, Vec inverse_scale, int32x4_t& sum) {
  int32x4_t quad = vdupq_n_s32(0);
  for (std::int32_t i = 0; i < 4; ++i) {
    const int32x4_t q = vcvtnq_s32_f32(vmulq_f32(outputs.at(k + i), inverse_scale));
    sum = vaddq_s32(sum, q);
    const int32x4_t byte = vandq_s32(q, vdupq_n_s32(0xFF));
    quad = vorrq_s32(quad, vshlq_s32(byte, vdupq_n_s32(8 * i)));
  }
  return quad;
}

// Returns the sums.
int32x4_t write_quads(const Outputs& outputs, Vec inverse_scale, std::int8_t* y) {
  int32x4_t sum = vdupq_n_s32(0);
  for (std::int32_t k = 0; k < outputs.reduction; k += outputs.together, y += 4 * kPanel) {
    auto* to = reinterpret_cast<std::int32_t*>(y);
    int32x4x2_t quads;
    quads.val[0] = quad_at(outputs, k, inverse_scale, sum);
    if (outputs.together == 4) {
      vst1q_s32(to, quads.val[0]);
    } else {
      quads.val[1] = quad_at(outputs, k + 4, inverse_scale, sum);
      vst2q_s32(to, quads);
    }
  }
  return sum;
}

}  // namespace

void quantize_to_int8(const QuantizeToInt8Args& a) {
  const std::int32_t inputs = a.in_blocks * kBlock, all = a.out_blocks * kBlock;
  const std::int32_t reduction = (a.in_blocks + 1) / 2 * kPanel;
  for (std::int32_t channel = 0; channel < all; channel += kLanes) {
    const std::int32_t first = channel / kPanel * kPanel;  // output of the panel
    const std::int32_t width = all - first < kPanel ? kBlock : kPanel;
    const Outputs outputs{a.weights + std::ptrdiff_t{first} * inputs + channel - first, width,
                          inputs, reduction, std::min(width, a.panel) == kPanel ? 4 : 8};
    const Vec scales = scales_of(outputs);
    const Vec inverse = only(vcgtq_f32(scales, splat(0.0f)), divide(splat(1.0f), scales));
    const std::int32_t lane = channel % std::min(width, a.panel);
    const int32x4_t sums =
        write_quads(outputs, inverse,
                    a.quads + std::ptrdiff_t{channel - lane} * reduction + lane * outputs.together);
    store(a.scales + channel, scales);
    store(a.sums + channel, vcvtq_f32_s32(sums));
  }
}

}  // namespace mien::kernels::MIEN_TIER
