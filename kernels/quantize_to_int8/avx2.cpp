// The avx2 tier of quantize_to_int8, which all tiers of x86 with 8-bit products use.
#include "kernels/common/avx2_quantized_panels.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {
namespace {

Vec scales_of(const Outputs& outputs) {
  Vec largest = _mm256_setzero_ps();
  for (std::int32_t k = 0; k < outputs.inputs; ++k) {
    largest = _mm256_max_ps(largest, _mm256_andnot_ps(_mm256_set1_ps(-0.0f), outputs.at(k)));
  }
  return _mm256_mul_ps(largest, _mm256_set1_ps(1.0f / kInt8WeightMax));
}

// Quantized elements k .. k + 3 of the sum, for each output; adds them to `sum`.
__m256i quad_at(const Outputs& outputs, std::int32_t k, Vec inverse_scale, __m256i& sum) {
  __m256i quad = _mm256_setzero_si256();
  for (std::int32_t i = 0; i < 4; ++i) {
    const __m256i q = _mm256_cvtps_epi32(_mm256_mul_ps(outputs.at(k + i), inverse_scale));
    sum = _mm256_add_epi32(sum, q);
    const __m256i byte = _mm256_and_si256(q, _mm256_set1_epi32(0xFF));
    quad = _mm256_or_si256(quad, _mm256_slli_epi32(byte, 8 * i));
  }
  return quad;
}

}  // namespace

void quantize_to_int8(const QuantizeToInt8Args& a) {
  const std::int32_t reduction = (a.in_blocks + 1) / 2 * kPanel;
  for_each_block(a, reduction, a.quads, sizeof *a.quads,
                 [&](const Outputs& outputs, std::ptrdiff_t channel, __m256i* y) {
                   const Vec scales = scales_of(outputs), inverse_scale = inverse(scales);
                   __m256i sum = _mm256_setzero_si256();
                   write_groups<4>(
                       outputs,
                       [&](std::int32_t k) { return quad_at(outputs, k, inverse_scale, sum); }, y);
                   _mm256_storeu_ps(a.scales + channel, scales);
                   _mm256_storeu_ps(a.sums + channel, _mm256_cvtepi32_ps(sum));
                 });
}

}  // namespace mien::kernels::avx2
