// The avx2 tier of quantize_weights, which all quantized tiers of x86 use.
#include "kernels/common/avx2_quantized_panels.h"
#include "kernels/families.h"
#include "kernels/quantize_weights/quantized_scale.h"

namespace mien::kernels::avx2 {
namespace {

Vec scales_of(const QuantizeWeightsArgs& a, const Outputs& outputs) {
  const Vec zero = _mm256_setzero_ps();
  Vec above = zero, below = zero, largest = zero;
  for (std::int32_t k = 0; k < outputs.reduction; ++k) {
    const Vec w = outputs.at(k);
    above = _mm256_add_ps(above, _mm256_max_ps(w, zero));
    below = _mm256_sub_ps(below, _mm256_min_ps(w, zero));
    largest = _mm256_max_ps(largest, _mm256_andnot_ps(_mm256_set1_ps(-0.0f), w));
  }
  const Vec reach = a.is_signed ? _mm256_add_ps(above, below) : _mm256_max_ps(above, below);
  return _mm256_max_ps(_mm256_mul_ps(reach, _mm256_set1_ps(scale_of_reach(a))),
                       _mm256_mul_ps(largest, _mm256_set1_ps(kScaleOfLargest)));
}

// Quantized elements k and k + 1 of the sum, for each output.
__m256i pair_at(const Outputs& outputs, std::int32_t k, Vec inverse_scale) {
  const auto fixed = [&](std::int32_t i) {
    return _mm256_cvtps_epi32(_mm256_mul_ps(outputs.at(i), inverse_scale));
  };
  return _mm256_blend_epi16(fixed(k), _mm256_slli_epi32(fixed(k + 1), 16), 0xAA);
}

}  // namespace

void quantize_weights(const QuantizeWeightsArgs& a) {
  for_each_block(a, a.in_blocks * kLanes, a.pairs, sizeof *a.pairs,
                 [&](const Outputs& outputs, std::ptrdiff_t channel, __m256i* y) {
                   const Vec scales = scales_of(a, outputs), inverse_scale = inverse(scales);
                   _mm256_storeu_ps(a.scales + channel, scales);
                   write_groups<2>(
                       outputs, [&](std::int32_t k) { return pair_at(outputs, k, inverse_scale); },
                       y);
                 });
}

}  // namespace mien::kernels::avx2
