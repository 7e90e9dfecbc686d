// The depthwise part: 16 channels, up to 8 output pixels of a row at once.
#include <utility>

#include "kernels/common/avx512.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/float_strips.h"

namespace mien::kernels::avx512 {
namespace {

constexpr int kMostPixels = 8;

using FloatSlide = Slide<float>;

struct Window {
  const InvertedResidualArgs& a;
  const FloatSlide& s;
  std::ptrdiff_t y_plane_elems;
  bool both;           // the upper 8 channels exist
  const Vec* weights;  // 3x3: the nine
  Vec bias;
};

Vec weights_at(const InvertedResidualArgs& a, const FloatSlide& s, std::int32_t tap) {
  const std::ptrdiff_t taps = std::ptrdiff_t{a.kernel_h} * a.kernel_w;
  const std::uint16_t* w = a.slide.weights + (s.block * taps + tap) * kBlock;
  const auto half = [](const std::uint16_t* at) {
    return _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(at)));
  };
  const __m256 high = s.blocks > 1 ? half(w + taps * kBlock) : _mm256_setzero_ps();
  return _mm512_insertf32x8(_mm512_castps256_ps512(half(w)), high, 1);
}

template <int kPixels>
void store(const Window& m, const Vec (&sum)[kPixels], float* y) {
  const Vec low = _mm512_set1_ps(m.s.clamp.low), high = _mm512_set1_ps(m.s.clamp.high);
#pragma GCC unroll 8
  for (int p = 0; p < kPixels; ++p) {
    store_blocks(y + p * kBlock, m.y_plane_elems, m.both,
                 _mm512_min_ps(high, _mm512_max_ps(low, sum[p])));
  }
}

template <int kPixels>
void pixels_3x3(const Window& m, const float* x, float* y) {
  const std::ptrdiff_t step = std::ptrdiff_t{m.a.stride_w} * kPanel;
  Vec sum[kPixels];
  for (Vec& one : sum) {
    one = m.bias;
  }
#pragma GCC unroll 3
  for (int ky = 0; ky < 3; ++ky, x += m.s.x_row_elems) {
#pragma GCC unroll 3
    for (int kx = 0; kx < 3; ++kx) {
#pragma GCC unroll 8
      for (int p = 0; p < kPixels; ++p) {
        const Vec value = _mm512_loadu_ps(x + p * step + kx * kPanel);
        sum[p] = _mm512_fmadd_ps(value, m.weights[3 * ky + kx], sum[p]);
      }
    }
  }
  store(m, sum, y);
}

// Any other kernel, one pixel at a time.
void pixel_any(const Window& m, const float* x, float* y) {
  Vec sum[1] = {m.bias};
  for (std::int32_t ky = 0; ky < m.a.kernel_h; ++ky, x += m.s.x_row_elems) {
    for (std::int32_t kx = 0; kx < m.a.kernel_w; ++kx) {
      const Vec value = _mm512_loadu_ps(x + std::ptrdiff_t{kx} * kPanel);
      sum[0] = _mm512_fmadd_ps(value, weights_at(m.a, m.s, ky * m.a.kernel_w + kx), sum[0]);
    }
  }
  store(m, sum, y);
}

using Pixels = void (*)(const Window&, const float*, float*);

template <int... kLess>
Pixels pixels_of(std::int32_t count, std::integer_sequence<int, kLess...>) {
  static constexpr Pixels kAll[] = {&pixels_3x3<kLess + 1>...};
  return kAll[count - 1];
}

// A row in parts of nearly equal size.
void row_3x3(const Window& m, const float* x, float* y) {
  const std::int32_t w = m.a.out_w, parts = (w + kMostPixels - 1) / kMostPixels;
  for (std::int32_t i = 0, done = 0; i < parts; ++i) {
    const std::int32_t count = (w - done + parts - i - 1) / (parts - i);
    pixels_of(count, std::make_integer_sequence<int, kMostPixels>())(
        m, x + std::ptrdiff_t{done} * m.a.stride_w * kPanel, y + std::ptrdiff_t{done} * kBlock);
    done += count;
  }
}

void row_any(const Window& m, const float* x, float* y) {
  for (std::int32_t ox = 0; ox < m.a.out_w; ++ox) {
    pixel_any(m, x + std::ptrdiff_t{ox} * m.a.stride_w * kPanel, y + std::ptrdiff_t{ox} * kBlock);
  }
}

struct Tier512 {
  static void multiply(const ProductArgs& args) { multiply_panels(args); }

  static void slide(const InvertedResidualArgs& a, const FloatSlide& s) {
    const bool is_3x3 = a.kernel_h == 3 && a.kernel_w == 3;
    Vec weights[9];
    for (std::int32_t tap = 0; is_3x3 && tap < 9; ++tap) {
      weights[tap] = weights_at(a, s, tap);
    }
    const bool both = s.blocks > 1;
    const Window m{a,    s,       band_plane(a, s),
                   both, weights, load_half(a.slide.bias + s.block * kBlock, both ? 0xFFFF : 0xFF)};
    float* band = band_at(a, s);
    for (std::int32_t row = 0; row < s.rows; ++row) {
      const float* x = s.x + row * a.stride_h * s.x_row_elems;
      float* y = band + std::ptrdiff_t{row} * a.out_w * kBlock;
      is_3x3 ? row_3x3(m, x, y) : row_any(m, x, y);
    }
  }

  static void load(const float* x, float* y) { _mm256_storeu_ps(y, _mm256_loadu_ps(x)); }
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) {
  InvertedResidual<FloatStrips<Tier512>>(a).run();
}

}  // namespace mien::kernels::avx512
