// Loops over panels of weights that are quantized, for the avx2 tier.
#pragma once

#include "kernels/common/avx2.h"

namespace mien::kernels::avx2 {
namespace {

// The fp16 weights of 8 outputs of a panel, padded with zeros.
struct Outputs {
  const std::uint16_t* weights;
  std::int32_t width;  // of the panel: 16 or 8
  std::int32_t inputs, reduction;
  [[nodiscard]] Vec at(std::int32_t k) const {
    return k < inputs ? load_half(weights + std::ptrdiff_t{k} * width) : _mm256_setzero_ps();
  }
};

inline Vec inverse(Vec scales) {  // 0 of 0
  const Vec any = _mm256_cmp_ps(scales, _mm256_setzero_ps(), _CMP_GT_OQ);
  return _mm256_and_ps(any, _mm256_div_ps(_mm256_set1_ps(1.0f), scales));
}

// Writes 32 bits of each output at once: group(k) are the elements k .. k + kGroup - 1 of the sum.
template <std::int32_t kGroup, class Group>
void write_groups(const Outputs& outputs, const Group& group, __m256i* y) {
  if (outputs.width == kPanel) {
    for (std::int32_t k = 0; k < outputs.reduction; k += kGroup, y += 2) {
      _mm256_storeu_si256(y, group(k));
    }
    return;
  }
  for (std::int32_t k = 0; k < outputs.reduction; k += 2 * kGroup, y += 2) {
    const __m256i first = group(k), second = group(k + kGroup);
    const __m256i low = _mm256_unpacklo_epi32(first, second);  // outputs 0, 1, 4, 5
    const __m256i high = _mm256_unpackhi_epi32(first, second);
    _mm256_storeu_si256(y, _mm256_permute2x128_si256(low, high, 0x20));
    _mm256_storeu_si256(y + 1, _mm256_permute2x128_si256(low, high, 0x31));
  }
}

// Calls run(outputs, block, y) for all 8 outputs of each block; y is where their integers, each
// `bytes` long, begin.
template <class Args, class Run>
void for_each_block(const Args& a, std::int32_t reduction, void* to, int bytes, const Run& run) {
  const std::int32_t inputs = a.in_blocks * kLanes;
  for (std::int32_t block = 0; block < a.out_blocks; ++block) {
    const std::int32_t half = block % 2, width = block - half + 1 < a.out_blocks ? kPanel : kLanes;
    const std::ptrdiff_t first = std::ptrdiff_t{block - half} * kLanes;  // output of the panel
    const Outputs outputs{a.weights + first * inputs + half * kLanes, width, inputs, reduction};
    auto* y = reinterpret_cast<__m256i*>(static_cast<char*>(to) + first * reduction * bytes);
    run(outputs, std::ptrdiff_t{block} * kLanes, y + half);
  }
}

}  // namespace
}  // namespace mien::kernels::avx2
