// The avx2int16 tier of inverted_residual. Its depthwise part computes 8 channels at once: half a
// panel.
#include "kernels/common/avx2.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/depthwise_rows.h"
#include "kernels/inverted_residual/quantized_strips.h"

namespace mien::kernels::avx2int16 {
namespace {

using avx2::kLanes;
using avx2::load_half;
using avx2::Vec;

// 8 floats to 8 integers of 16 bits; larger ones saturate.
__m128i fixed(Vec values) {
  const __m256i wide = _mm256_cvtps_epi32(values);
  return _mm_packs_epi32(_mm256_castsi256_si128(wide), _mm256_extracti128_si256(wide, 1));
}

Vec magnitude(Vec values) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), values); }

// Computes quantized values of the band.
struct Window {
  using Value = float;
  using Vec = avx2int16::Vec;
  static constexpr std::ptrdiff_t kStrip = kFloatPanel, kBand = kQuantizedBand;

  const InvertedResidualArgs& a;
  std::ptrdiff_t x_row_elems;
  const std::uint16_t* weights;  // [kernel_h][kernel_w][8]
  bool is_int8;
  Vec factor, bias, high;

  static Vec load(const float* x) { return _mm256_loadu_ps(x); }
  static Vec fma(Vec sum, Vec value, Vec weight) { return _mm256_fmadd_ps(value, weight, sum); }
  [[nodiscard]] Vec weight(int tap) const {
    return _mm256_mul_ps(load_half(weights + tap * kLanes), factor);
  }
  void store(Vec sum, float* y) const {
    const Vec clamped = _mm256_min_ps(high, _mm256_max_ps(_mm256_setzero_ps(), sum));
    const __m128i words = fixed(clamped);
    if (is_int8) {
      _mm_storel_epi64(reinterpret_cast<__m128i*>(y), _mm_packus_epi16(words, words));
    } else {
      _mm_storeu_si128(reinterpret_cast<__m128i*>(y), words);
    }
  }
};

// `half` 0: the lower 8 channels of the panel; 1: the upper 8.
void depthwise_half(const InvertedResidualArgs& a, const DepthwisePart<float>& s, std::int32_t half,
                    const BandQuantization& quantization, float* y) {
  const std::ptrdiff_t taps = std::ptrdiff_t{a.kernel_h} * a.kernel_w;
  const std::int32_t block = s.block + half;
  const Vec factor = _mm256_set1_ps(quantization.factor());
  const std::ptrdiff_t upper =
      quantization.is_int8 ? kQuantizedBand / 2 : quantized_band_plane(a, s);
  const Window window{a,
                      s.x_row_elems,
                      a.depthwise.weights + block * taps * kLanes,
                      quantization.is_int8,
                      factor,
                      _mm256_mul_ps(load_half(a.depthwise.bias + block * kLanes), factor),
                      _mm256_set1_ps(quantization.max)};
  DepthwiseRows<Window>::run(window, s.rows, s.x + std::ptrdiff_t{half} * kLanes, y + half * upper);
}

struct TierInt16 {
  MultiplyQuantized multiply;

  static void load(const float* x, float* y) { _mm256_storeu_ps(y, _mm256_loadu_ps(x)); }

  static float largest_of(const float* x, std::ptrdiff_t elems) {
    constexpr int kAtOnce = 4;  // independent, because each maximum waits for the previous one
    Vec largest[kAtOnce];
    for (Vec& one : largest) {
      one = _mm256_set1_ps(kMinMagnitude);
    }
    const auto take = [](Vec& one, Vec values) { one = _mm256_max_ps(one, magnitude(values)); };
    for (; elems >= kLanes * kAtOnce; elems -= kLanes * kAtOnce, x += kLanes * kAtOnce) {
      for (int k = 0; k < kAtOnce; ++k) {
        take(largest[k], _mm256_loadu_ps(x + kLanes * k));
      }
    }
    for (; elems > 0; elems -= kLanes, x += kLanes) {
      take(largest[0], _mm256_loadu_ps(x));
    }
    for (int k = 1; k < kAtOnce; ++k) {
      take(largest[0], largest[k]);
    }
    float lanes[kLanes], all = kMinMagnitude;
    _mm256_storeu_ps(lanes, largest[0]);
    for (const float one : lanes) {
      all = std::max(all, one);
    }
    return all;
  }

  static void quantize(const float* x, std::ptrdiff_t elems, float inverse_scale, std::int16_t* y) {
    const Vec factor = _mm256_set1_ps(inverse_scale);
    for (; elems > 0; elems -= kLanes, x += kLanes, y += kLanes) {
      const Vec values = _mm256_mul_ps(_mm256_loadu_ps(x), factor);
      _mm_storeu_si128(reinterpret_cast<__m128i*>(y), fixed(values));
    }
  }

  static void quantize_to_int8(const float* x, std::int32_t pixels, float inverse_scale,
                               std::int16_t* y) {
    const Vec factor = _mm256_set1_ps(inverse_scale);
    const Vec low = _mm256_set1_ps(-kInt8MapMax), high = _mm256_set1_ps(kInt8MapMax);
    for (; pixels > 0; --pixels, x += kLanes, y += kQuantizedPixel) {
      const Vec values = _mm256_mul_ps(_mm256_loadu_ps(x), factor);
      const __m128i words = fixed(_mm256_min_ps(_mm256_max_ps(values, low), high));
      _mm_storel_epi64(reinterpret_cast<__m128i*>(y),
                       _mm_xor_si128(_mm_packs_epi16(words, words),
                                     _mm_set1_epi8(static_cast<char>(kInt8Shift))));
    }
  }

  static void depthwise(const InvertedResidualArgs& a, const DepthwisePart<float>& s,
                        const BandQuantization& quantization, float* y) {
    depthwise_half(a, s, 0, quantization, y);
    if (s.blocks > 1) {
      depthwise_half(a, s, 1, quantization, y);
    }
  }
};

}  // namespace

void quantized_block(const InvertedResidualArgs& a, MultiplyQuantized multiply) {
  using Strips = QuantizedStrips<TierInt16>;
  if (Strips::can_run(a)) {
    InvertedResidual<Strips>(a, Strips(a, {multiply})).run();
  } else {
    avx2::inverted_residual(a);
  }
}

void inverted_residual(const InvertedResidualArgs& a) { quantized_block(a, &multiply_quantized); }

}  // namespace mien::kernels::avx2int16
