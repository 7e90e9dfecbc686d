// The avx512vnni tier of quantize_weights.
#include "kernels/common/avx512.h"
#include "kernels/families.h"
#include "kernels/quantize_weights/quantized_scale.h"

namespace mien::kernels::avx512vnni {
namespace {

using avx512::kBlock;
using avx512::kPanel;
using avx512::Vec;

// A panel: the weights of up to 16 outputs.
struct Panel {
  const std::uint16_t* weights;
  std::int32_t width;  // 16 or 8
  std::int32_t reduction;
  [[nodiscard]] __mmask16 lanes() const { return avx512::first_lanes(width); }
  [[nodiscard]] Vec at(std::int32_t k) const {
    return avx512::load_half(weights + std::ptrdiff_t{k} * width, lanes());
  }
};

Vec scales_of(const QuantizeWeightsArgs& a, const Panel& panel) {
  const Vec zero = _mm512_setzero_ps();
  Vec above = zero, below = zero, largest = zero;
  for (std::int32_t k = 0; k < panel.reduction; ++k) {
    const Vec w = panel.at(k);
    above = _mm512_add_ps(above, _mm512_max_ps(w, zero));
    below = _mm512_sub_ps(below, _mm512_min_ps(w, zero));
    largest = _mm512_max_ps(largest, _mm512_abs_ps(w));
  }
  const Vec reach = a.is_signed ? _mm512_add_ps(above, below) : _mm512_max_ps(above, below);
  return _mm512_max_ps(_mm512_mul_ps(reach, _mm512_set1_ps(scale_of_reach(a))),
                       _mm512_mul_ps(largest, _mm512_set1_ps(kScaleOfLargest)));
}

// Quantized elements k and k + 1 of the sum, for each output.
__m512i pair_at(const Panel& panel, std::int32_t k, Vec inverse_scale) {
  const auto fixed = [&](std::int32_t i) {
    return _mm512_cvtps_epi32(_mm512_mul_ps(panel.at(i), inverse_scale));
  };
  return _mm512_mask_blend_epi16(0xAAAAAAAA, fixed(k), _mm512_slli_epi32(fixed(k + 1), 16));
}

void write_pairs(const Panel& panel, Vec inverse_scale, std::int16_t* pairs) {
  const __m512i order = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
  const std::int32_t at_once = 2 * kPanel / panel.width;
  for (std::int32_t k = 0; k < panel.reduction; k += at_once, pairs += 2 * kPanel) {
    __m512i pair = pair_at(panel, k, inverse_scale);
    if (panel.width < kPanel) {
      pair = _mm512_permutex2var_epi32(pair, order, pair_at(panel, k + 2, inverse_scale));
    }
    _mm512_storeu_si512(pairs, pair);
  }
}

}  // namespace

void quantize_weights(const QuantizeWeightsArgs& a) {
  const std::int32_t reduction = a.in_blocks * kBlock;
  for (std::int32_t block = 0; block < a.out_blocks; block += 2) {
    const std::ptrdiff_t first = std::ptrdiff_t{block} * kBlock;
    const Panel panel{a.weights + first * reduction, block + 1 < a.out_blocks ? kPanel : kBlock,
                      reduction};
    const Vec scales = scales_of(a, panel);
    _mm512_mask_storeu_ps(a.scales + first, panel.lanes(), scales);
    const __mmask16 any = _mm512_cmp_ps_mask(scales, _mm512_setzero_ps(), _CMP_GT_OQ);
    write_pairs(panel, _mm512_maskz_div_ps(any, _mm512_set1_ps(1.0f), scales),
                a.pairs + first * reduction);
  }
}

}  // namespace mien::kernels::avx512vnni
