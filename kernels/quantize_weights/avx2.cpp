// The avx2 tier of quantize_weights, which all quantized tiers of x86 use.
#include "kernels/common/avx2.h"
#include "kernels/families.h"
#include "kernels/quantize_weights/quantized_scale.h"

namespace mien::kernels::avx2 {
namespace {

// The weights of 8 outputs of a panel.
struct Outputs {
  const std::uint16_t* weights;
  std::int32_t width;  // of the panel: 16 or 8
  std::int32_t reduction;
  [[nodiscard]] Vec at(std::int32_t k) const {
    return load_half(weights + std::ptrdiff_t{k} * width);
  }
};

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

void store(std::int16_t* at, __m256i pairs) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(at), pairs);
}

// `pairs`: the first pair of these outputs.
void write_pairs(const Outputs& outputs, Vec inverse_scale, std::int16_t* pairs) {
  if (outputs.width == kPanel) {
    for (std::int32_t k = 0; k < outputs.reduction; k += 2, pairs += 2 * kPanel) {
      store(pairs, pair_at(outputs, k, inverse_scale));
    }
    return;
  }
  for (std::int32_t k = 0; k < outputs.reduction; k += 4, pairs += 2 * kPanel) {
    const __m256i first = pair_at(outputs, k, inverse_scale);
    const __m256i second = pair_at(outputs, k + 2, inverse_scale);
    const __m256i low = _mm256_unpacklo_epi32(first, second);  // outputs 0, 1, 4, 5
    const __m256i high = _mm256_unpackhi_epi32(first, second);
    store(pairs, _mm256_permute2x128_si256(low, high, 0x20));
    store(pairs + kPanel, _mm256_permute2x128_si256(low, high, 0x31));
  }
}

}  // namespace

void quantize_weights(const QuantizeWeightsArgs& a) {
  const std::int32_t reduction = a.in_blocks * kLanes;
  for (std::int32_t block = 0; block < a.out_blocks; ++block) {
    const std::int32_t half = block % 2, width = block - half + 1 < a.out_blocks ? kPanel : kLanes;
    const std::ptrdiff_t panel = std::ptrdiff_t{block - half} * kLanes * reduction;
    const Outputs outputs{a.weights + panel + half * kLanes, width, reduction};
    const Vec scales = scales_of(a, outputs);
    _mm256_storeu_ps(a.scales + std::ptrdiff_t{block} * kLanes, scales);
    const Vec any = _mm256_cmp_ps(scales, _mm256_setzero_ps(), _CMP_GT_OQ);
    const Vec inverse_scale = _mm256_and_ps(any, _mm256_div_ps(_mm256_set1_ps(1.0f), scales));
    write_pairs(outputs, inverse_scale, a.pairs + panel + half * kPanel);
  }
}

}  // namespace mien::kernels::avx2
