// The avx512vnni tier of inverted_residual.
#include "kernels/common/avx512.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/avx512_depthwise.h"
#include "kernels/inverted_residual/depthwise_rows.h"
#include "kernels/inverted_residual/quantized_strips.h"

namespace mien::kernels::avx512vnni {
namespace {

using avx512::Vec;

// Computes quantized values of the band.
struct Window {
  using Value = float;
  using Vec = avx512vnni::Vec;
  static constexpr std::ptrdiff_t kStrip = kFloatPanel, kBand = kQuantizedBand;

  const InvertedResidualArgs& a;
  const DepthwisePart<float>& s;
  std::ptrdiff_t x_row_elems;
  std::ptrdiff_t y_plane_elems;
  bool both;  // the upper 8 channels exist
  bool is_int8;
  Vec factor, bias, high;

  static Vec load(const float* x) { return _mm512_loadu_ps(x); }
  static Vec fma(Vec sum, Vec value, Vec weight) { return _mm512_fmadd_ps(value, weight, sum); }
  [[nodiscard]] Vec weight(int tap) const {
    return _mm512_mul_ps(avx512::weights_at(a, s, tap), factor);
  }
  void store(Vec sum, float* y) const {
    const Vec clamped = _mm512_min_ps(high, _mm512_max_ps(_mm512_setzero_ps(), sum));
    const __m512i wide = _mm512_cvtps_epi32(clamped);
    if (is_int8) {
      _mm_storeu_si128(reinterpret_cast<__m128i*>(y), _mm512_cvtepi32_epi8(wide));
      return;
    }
    const __m256i fixed = _mm512_cvtepi32_epi16(wide);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(y), _mm256_castsi256_si128(fixed));
    if (both) {
      _mm_storeu_si128(reinterpret_cast<__m128i*>(y + y_plane_elems),
                       _mm256_extracti128_si256(fixed, 1));
    }
  }
};

struct TierVnni {
  static void load(const float* x, float* y) { _mm256_storeu_ps(y, _mm256_loadu_ps(x)); }

  static float largest_of(const float* x, std::ptrdiff_t elems) {
    constexpr int kAtOnce = 4;  // independent, because each maximum waits for the previous one
    Vec largest[kAtOnce];
    for (Vec& one : largest) {
      one = _mm512_set1_ps(kMinMagnitude);
    }
    const auto take = [&](Vec& one, Vec values) {
      one = _mm512_max_ps(one, _mm512_abs_ps(values));
    };
    for (; elems >= 16 * kAtOnce; elems -= 16 * kAtOnce, x += 16 * kAtOnce) {
      for (int k = 0; k < kAtOnce; ++k) {
        take(largest[k], _mm512_loadu_ps(x + 16 * k));
      }
    }
    for (; elems > 0; elems -= 16, x += 16) {
      take(largest[0],
           _mm512_maskz_loadu_ps(avx512::first_lanes(static_cast<std::int32_t>(elems)), x));
    }
    for (int k = 1; k < kAtOnce; ++k) {
      take(largest[0], largest[k]);
    }
    return _mm512_reduce_max_ps(largest[0]);
  }

  static void quantize(const float* x, std::ptrdiff_t elems, float inverse_scale, std::int16_t* y) {
    const Vec factor = _mm512_set1_ps(inverse_scale);
    for (; elems > 0; elems -= 16, x += 16, y += 16) {
      const __mmask16 lanes = elems >= 16 ? 0xFFFF : 0xFF;
      const Vec values = _mm512_mul_ps(_mm512_maskz_loadu_ps(lanes, x), factor);
      _mm256_mask_storeu_epi16(y, lanes, _mm512_cvtsepi32_epi16(_mm512_cvtps_epi32(values)));
    }
  }

  // Two pixels at once.
  static void quantize_to_int8(const float* x, std::int32_t pixels, float inverse_scale,
                               std::int16_t* y) {
    const Vec factor = _mm512_set1_ps(inverse_scale);
    const Vec low = _mm512_set1_ps(-kInt8MapMax), high = _mm512_set1_ps(kInt8MapMax);
    for (std::int32_t left = pixels; left > 0; left -= 2, x += 16, y += 2 * kQuantizedPixel) {
      const Vec values = _mm512_mul_ps(_mm512_maskz_loadu_ps(left > 1 ? 0xFFFF : 0xFF, x), factor);
      const Vec clamped = _mm512_min_ps(_mm512_max_ps(values, low), high);
      const __m128i fixed = _mm_xor_si128(_mm512_cvtepi32_epi8(_mm512_cvtps_epi32(clamped)),
                                          _mm_set1_epi8(static_cast<char>(kInt8Shift)));
      _mm_storel_epi64(reinterpret_cast<__m128i*>(y), fixed);
      if (left > 1) {
        _mm_storel_epi64(reinterpret_cast<__m128i*>(y + kQuantizedPixel),
                         _mm_unpackhi_epi64(fixed, fixed));
      }
    }
  }

  static void depthwise(const InvertedResidualArgs& a, const DepthwisePart<float>& s,
                        const BandQuantization& quantization, float* y) {
    const bool both = s.blocks > 1;
    const Vec factor = _mm512_set1_ps(quantization.factor());
    const Window window{a,
                        s,
                        s.x_row_elems,
                        quantized_band_plane(a, s),
                        both,
                        quantization.is_int8,
                        factor,
                        _mm512_mul_ps(avx512::load_half(a.depthwise.bias + s.block * kStripBlock,
                                                        both ? 0xFFFF : 0xFF),
                                      factor),
                        _mm512_set1_ps(quantization.max)};
    DepthwiseRows<Window>::run(window, s.rows, s.x, y);
  }

  static void multiply(const QuantizedProduct& product) { multiply_quantized(product); }
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) {
  using Strips = QuantizedStrips<TierVnni>;
  if (Strips::can_run(a)) {
    InvertedResidual<Strips>(a).run();
  } else {
    avx512::inverted_residual(a);
  }
}

}  // namespace mien::kernels::avx512vnni
