// The avx2 tier of quantize_to_int8, which all tiers with 8-bit products use.
#include <algorithm>

#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {
namespace {

// The weights of 8 outputs of a panel.
struct Outputs {
  const std::uint16_t* weights;
  std::int32_t width;  // of the panel: 16 or 8
  std::int32_t inputs;
  [[nodiscard]] Vec at(std::int32_t k) const {
    return k < inputs ? load_half(weights + std::ptrdiff_t{k} * width) : _mm256_setzero_ps();
  }
};

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

void store(std::int8_t* at, __m256i quads) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(at), quads);
}

// `quads`: the first quad of these outputs. Returns the sum of each output's integers.
__m256i write_quads(const Outputs& outputs, std::int32_t reduction, Vec inverse_scale,
                    std::int8_t* quads) {
  __m256i sum = _mm256_setzero_si256();
  const auto quad = [&](std::int32_t k) { return quad_at(outputs, k, inverse_scale, sum); };
  if (outputs.width == kPanel) {
    for (std::int32_t k = 0; k < reduction; k += 4, quads += 4 * kPanel) {
      store(quads, quad(k));
    }
    return sum;
  }
  for (std::int32_t k = 0; k < reduction; k += 8, quads += 4 * kPanel) {
    const __m256i first = quad(k), second = quad(k + 4);
    const __m256i low = _mm256_unpacklo_epi32(first, second);  // outputs 0, 1, 4, 5
    const __m256i high = _mm256_unpackhi_epi32(first, second);
    store(quads, _mm256_permute2x128_si256(low, high, 0x20));
    store(quads + 2 * kPanel, _mm256_permute2x128_si256(low, high, 0x31));
  }
  return sum;
}

}  // namespace

void quantize_to_int8(const QuantizeToInt8Args& a) {
  const std::int32_t inputs = a.in_blocks * kLanes, reduction = (a.in_blocks + 1) / 2 * kPanel;
  for (std::int32_t block = 0; block < a.out_blocks; ++block) {
    const std::int32_t half = block % 2, width = block - half + 1 < a.out_blocks ? kPanel : kLanes;
    const std::ptrdiff_t first = std::ptrdiff_t{block - half} * kLanes;  // output of the panel
    const Outputs outputs{a.weights + first * inputs + half * kLanes, width, inputs};
    const Vec scales = scales_of(outputs);
    const Vec any = _mm256_cmp_ps(scales, _mm256_setzero_ps(), _CMP_GT_OQ);
    const Vec inverse_scale = _mm256_and_ps(any, _mm256_div_ps(_mm256_set1_ps(1.0f), scales));
    const __m256i sums = write_quads(outputs, reduction, inverse_scale,
                                     a.quads + first * reduction + half * 2 * kPanel);
    const std::ptrdiff_t channel = std::ptrdiff_t{block} * kLanes;
    _mm256_storeu_ps(a.scales + channel, scales);
    const __m256i offsets = _mm256_mullo_epi32(sums, _mm256_set1_epi32(-a.input_shift));
    _mm256_storeu_ps(a.offsets + channel, _mm256_cvtepi32_ps(offsets));
  }
}

}  // namespace mien::kernels::avx2
