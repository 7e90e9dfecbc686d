// Depthwise weights of a whole panel, for tiers with vectors of 16 floats.
#pragma once

#include "kernels/common/avx512.h"
#include "kernels/inverted_residual/strips.h"

namespace mien::kernels::avx512 {
namespace {

// The weights of one tap; 0 for the upper 8 channels if these do not exist.
inline Vec weights_at(const InvertedResidualArgs& a, const DepthwisePart<float>& s,
                      std::int32_t tap) {
  const std::ptrdiff_t taps = std::ptrdiff_t{a.kernel_h} * a.kernel_w;
  const std::uint16_t* w = a.depthwise.weights + (s.block * taps + tap) * kBlock;
  const auto half = [](const std::uint16_t* at) {
    return _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(at)));
  };
  const __m256 high = s.blocks > 1 ? half(w + taps * kBlock) : _mm256_setzero_ps();
  return _mm512_insertf32x8(_mm512_castps256_ps512(half(w)), high, 1);
}

}  // namespace
}  // namespace mien::kernels::avx512
