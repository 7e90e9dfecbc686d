// Helpers shared by the AVX2 kernels. All have internal linkage, so that the linker cannot merge
// code for AVX2 with code for every CPU.
#pragma once

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

#include "kernels/activation/activation.h"

namespace mien::kernels::avx2 {

constexpr std::int32_t kLanes = 8;
constexpr std::int32_t kPanel = 16;

namespace {

using Vec = __m256;

inline Vec load_half(const std::uint16_t* at) {
  return _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(at)));
}

[[maybe_unused]] inline std::int32_t blocks_of(std::int32_t channels) { return (channels + 7) / 8; }

// All bits set in the lanes of channels first .. first + 7 that exist, 0 in the others.
[[maybe_unused]] inline Vec lane_mask(std::int32_t first, std::int32_t channels) {
  const Vec lane = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
  return _mm256_cmp_ps(lane, _mm256_set1_ps(static_cast<float>(channels - first)), _CMP_LT_OQ);
}

// combine(lane 0, lane 1, .. lane 7)
template <class Combine>
[[maybe_unused]] inline float across(Vec x, Combine combine) {
  x = combine(x, _mm256_permute2f128_ps(x, x, 1));
  x = combine(x, _mm256_permute_ps(x, 0x4E));
  return _mm256_cvtss_f32(combine(x, _mm256_permute_ps(x, 0xB1)));
}

// exp(x) to 2 ulp on [-87, 88], clamped outside: 2^n e^r with r in [-ln2/2, ln2/2], a polynomial of
// degree 6 (Cephes expf by S. Moshier).
[[maybe_unused]] inline Vec exp(Vec x) {
  x = _mm256_min_ps(_mm256_max_ps(x, _mm256_set1_ps(-87.0f)), _mm256_set1_ps(88.0f));
  const Vec n = _mm256_round_ps(_mm256_mul_ps(x, _mm256_set1_ps(1.44269504f)),
                                _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  Vec r = _mm256_fnmadd_ps(n, _mm256_set1_ps(0.693359375f), x);
  r = _mm256_fnmadd_ps(n, _mm256_set1_ps(-2.12194440e-4f), r);
  Vec p = _mm256_set1_ps(1.9875691500e-4f);
  p = _mm256_fmadd_ps(p, r, _mm256_set1_ps(1.3981999507e-3f));
  p = _mm256_fmadd_ps(p, r, _mm256_set1_ps(8.3334519073e-3f));
  p = _mm256_fmadd_ps(p, r, _mm256_set1_ps(4.1665795894e-2f));
  p = _mm256_fmadd_ps(p, r, _mm256_set1_ps(1.6666665459e-1f));
  p = _mm256_fmadd_ps(p, r, _mm256_set1_ps(5.0000001201e-1f));
  p = _mm256_fmadd_ps(p, _mm256_mul_ps(r, r), _mm256_add_ps(r, _mm256_set1_ps(1.0f)));
  const __m256i bits =
      _mm256_slli_epi32(_mm256_add_epi32(_mm256_cvtps_epi32(n), _mm256_set1_epi32(127)), 23);
  return _mm256_mul_ps(p, _mm256_castsi256_ps(bits));
}

[[maybe_unused]] inline Vec sigmoid(Vec x) {
  const Vec one = _mm256_set1_ps(1.0f);
  return _mm256_div_ps(one, _mm256_add_ps(one, exp(_mm256_sub_ps(_mm256_setzero_ps(), x))));
}

// 1 - 2 / (exp(2x) + 1), or near zero, because of cancellation, x - x^3/3 + 2x^5/15 - 17x^7/315.
[[maybe_unused]] inline Vec tanh(Vec x) {
  const Vec one = _mm256_set1_ps(1.0f);
  const Vec large = _mm256_sub_ps(
      one, _mm256_div_ps(_mm256_set1_ps(2.0f), _mm256_add_ps(exp(_mm256_add_ps(x, x)), one)));
  const Vec s = _mm256_mul_ps(x, x);
  Vec p = _mm256_set1_ps(62.0f / 2835.0f);
  p = _mm256_fmadd_ps(p, s, _mm256_set1_ps(-17.0f / 315.0f));
  p = _mm256_fmadd_ps(p, s, _mm256_set1_ps(2.0f / 15.0f));
  p = _mm256_fmadd_ps(p, s, _mm256_set1_ps(-1.0f / 3.0f));
  const Vec small = _mm256_fmadd_ps(_mm256_mul_ps(p, s), x, x);
  const Vec magnitude = _mm256_andnot_ps(_mm256_set1_ps(-0.0f), x);
  return _mm256_blendv_ps(large, small, _mm256_cmp_ps(magnitude, _mm256_set1_ps(0.2f), _CMP_LT_OQ));
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

// Applies the activation to block `block` of a map with `channels` channels.
[[maybe_unused]] inline Vec activated(Vec x, const ActivationSpec& activation, std::int32_t block,
                                      std::int32_t channels) {
  const Vec zero = _mm256_setzero_ps();
  switch (activation.kind) {
    case Activation::kNone:
      return x;
    case Activation::kRelu:
      return _mm256_max_ps(x, zero);
    case Activation::kRelu6:
      return _mm256_min_ps(_mm256_max_ps(x, zero), _mm256_set1_ps(6.0f));
    case Activation::kLeakyRelu:
      return _mm256_blendv_ps(_mm256_mul_ps(x, _mm256_set1_ps(activation.alpha)), x,
                              _mm256_cmp_ps(x, zero, _CMP_GT_OQ));
    case Activation::kPrelu:
      return _mm256_blendv_ps(_mm256_mul_ps(x, load_half(activation.slopes + block * kLanes)), x,
                              _mm256_cmp_ps(x, zero, _CMP_GT_OQ));
    case Activation::kSigmoid:  // the only one that maps 0 in unused lanes to another value
      return _mm256_and_ps(sigmoid(x), lane_mask(block * kLanes, channels));
    case Activation::kTanh:
      return tanh(x);
    case Activation::kClamp01:
      return _mm256_min_ps(_mm256_max_ps(x, zero), _mm256_set1_ps(1.0f));
  }
  return x;
}

}  // namespace
}  // namespace mien::kernels::avx2
