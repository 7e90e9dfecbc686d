// Helpers shared by the AVX-512 kernels. All have internal linkage, so that the linker cannot merge
// code for AVX-512 with code for every CPU.
#pragma once

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

#include "kernels/activation/activation.h"

namespace mien::kernels::avx512 {

constexpr std::int32_t kBlock = 8;   // channels of a block of a map
constexpr std::int32_t kPanel = 16;  // output channels of a panel of weights: one vector

namespace {

using Vec = __m512;

[[maybe_unused]] inline std::int32_t blocks_of(std::int32_t channels) { return (channels + 7) / 8; }

// Mask of the first `count` lanes, 0 to 16.
[[maybe_unused]] inline __mmask16 first_lanes(std::int32_t count) {
  return count >= kPanel ? __mmask16{0xFFFF} : static_cast<__mmask16>((1u << count) - 1);
}

[[maybe_unused]] inline Vec load_half(const std::uint16_t* at) {
  return _mm512_cvtph_ps(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(at)));
}

// Loads only the lanes of the mask; the others are 0.
[[maybe_unused]] inline Vec load_half(const std::uint16_t* at, __mmask16 lanes) {
  return _mm512_cvtph_ps(_mm256_maskz_loadu_epi16(lanes, at));
}

// Loads and stores two blocks of a map as one vector. If not `both`, the upper half is 0 and is not
// stored.
[[maybe_unused]] inline Vec load_blocks(const float* at, std::ptrdiff_t plane, bool both) {
  const Vec low = _mm512_castps256_ps512(_mm256_loadu_ps(at));
  const __m256 high = both ? _mm256_loadu_ps(at + plane) : _mm256_setzero_ps();
  return _mm512_insertf32x8(low, high, 1);
}
[[maybe_unused]] inline void store_blocks(float* at, std::ptrdiff_t plane, bool both, Vec value) {
  _mm256_storeu_ps(at, _mm512_castps512_ps256(value));
  if (both) {
    _mm256_storeu_ps(at + plane, _mm512_extractf32x8_ps(value, 1));
  }
}

// exp(x) to 2 ulp on [-87, 88], clamped outside: 2^n e^r with r in [-ln2/2, ln2/2], a polynomial of
// degree 6 (Cephes expf by S. Moshier).
[[maybe_unused]] inline Vec exp(Vec x) {
  x = _mm512_min_ps(_mm512_max_ps(x, _mm512_set1_ps(-87.0f)), _mm512_set1_ps(88.0f));
  const Vec n = _mm512_roundscale_ps(_mm512_mul_ps(x, _mm512_set1_ps(1.44269504f)),
                                     _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  Vec r = _mm512_fnmadd_ps(n, _mm512_set1_ps(0.693359375f), x);
  r = _mm512_fnmadd_ps(n, _mm512_set1_ps(-2.12194440e-4f), r);
  Vec p = _mm512_set1_ps(1.9875691500e-4f);
  p = _mm512_fmadd_ps(p, r, _mm512_set1_ps(1.3981999507e-3f));
  p = _mm512_fmadd_ps(p, r, _mm512_set1_ps(8.3334519073e-3f));
  p = _mm512_fmadd_ps(p, r, _mm512_set1_ps(4.1665795894e-2f));
  p = _mm512_fmadd_ps(p, r, _mm512_set1_ps(1.6666665459e-1f));
  p = _mm512_fmadd_ps(p, r, _mm512_set1_ps(5.0000001201e-1f));
  p = _mm512_fmadd_ps(p, _mm512_mul_ps(r, r), _mm512_add_ps(r, _mm512_set1_ps(1.0f)));
  return _mm512_scalef_ps(p, n);
}

[[maybe_unused]] inline Vec sigmoid(Vec x) {
  const Vec one = _mm512_set1_ps(1.0f);
  return _mm512_div_ps(one, _mm512_add_ps(one, exp(_mm512_sub_ps(_mm512_setzero_ps(), x))));
}

// 1 - 2 / (exp(2x) + 1), or near zero, because of cancellation, x - x^3/3 + 2x^5/15 - 17x^7/315.
[[maybe_unused]] inline Vec tanh(Vec x) {
  const Vec one = _mm512_set1_ps(1.0f);
  const Vec large = _mm512_sub_ps(
      one, _mm512_div_ps(_mm512_set1_ps(2.0f), _mm512_add_ps(exp(_mm512_add_ps(x, x)), one)));
  const Vec s = _mm512_mul_ps(x, x);
  Vec p = _mm512_set1_ps(62.0f / 2835.0f);
  p = _mm512_fmadd_ps(p, s, _mm512_set1_ps(-17.0f / 315.0f));
  p = _mm512_fmadd_ps(p, s, _mm512_set1_ps(2.0f / 15.0f));
  p = _mm512_fmadd_ps(p, s, _mm512_set1_ps(-1.0f / 3.0f));
  const Vec small = _mm512_fmadd_ps(_mm512_mul_ps(p, s), x, x);
  const __mmask16 near = _mm512_cmp_ps_mask(_mm512_abs_ps(x), _mm512_set1_ps(0.2f), _CMP_LT_OQ);
  return _mm512_mask_blend_ps(near, large, small);
}

// Most activations are min(max(x, low), high).
struct Clamp {
  float low, high;
};

// Returns false for other activations; `clamp` is then infinite.
[[maybe_unused]] inline bool is_clamp(const ActivationSpec& activation, Clamp& clamp) {
  constexpr float kInfinity = __builtin_inff();
  clamp = {-kInfinity, kInfinity};
  switch (activation.kind) {
    case Activation::kNone:
      return true;
    case Activation::kRelu:
      clamp.low = 0.0f;
      return true;
    case Activation::kRelu6:
      clamp = {0.0f, 6.0f};
      return true;
    case Activation::kClamp01:
      clamp = {0.0f, 1.0f};
      return true;
    default:
      return false;
  }
}

// Applies the activation to the channels from `channel` on in `lanes`; the other lanes become 0.
[[maybe_unused]] inline Vec activated(Vec x, const ActivationSpec& activation, std::int32_t channel,
                                      __mmask16 lanes) {
  const __mmask16 positive = _mm512_cmp_ps_mask(x, _mm512_setzero_ps(), _CMP_GT_OQ);
  Vec y;
  switch (activation.kind) {
    case Activation::kLeakyRelu:
      y = _mm512_mask_blend_ps(positive, _mm512_mul_ps(x, _mm512_set1_ps(activation.alpha)), x);
      break;
    case Activation::kPrelu:
      y = _mm512_mask_blend_ps(positive,
                               _mm512_mul_ps(x, load_half(activation.slopes + channel, lanes)), x);
      break;
    case Activation::kSigmoid:
      y = sigmoid(x);
      break;
    case Activation::kTanh:
      y = tanh(x);
      break;
    default: {
      Clamp clamp;
      (void)is_clamp(activation, clamp);
      y = _mm512_min_ps(_mm512_set1_ps(clamp.high), _mm512_max_ps(_mm512_set1_ps(clamp.low), x));
      break;
    }
  }
  return _mm512_maskz_mov_ps(lanes, y);
}

}  // namespace
}  // namespace mien::kernels::avx512
