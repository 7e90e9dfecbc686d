// The depthwise part: 8 channels, up to 8 output pixels of a row at once.
#include <utility>

#include "kernels/common/avx2.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/float_strips.h"

namespace mien::kernels::avx2 {
namespace {

constexpr int kMostPixels = 8;

struct Window {
  const InvertedResidualArgs& a;
  const Slide<float>& s;
  const float* weights;  // [kernel_h][kernel_w][8]; 3x3 only
  const std::uint16_t* halves;
  Vec bias;
};

template <int kPixels>
void store(const Window& m, const Vec (&sum)[kPixels], float* y) {
  const Vec low = _mm256_set1_ps(m.s.clamp.low), high = _mm256_set1_ps(m.s.clamp.high);
#pragma GCC unroll 8
  for (int p = 0; p < kPixels; ++p) {
    _mm256_storeu_ps(y + p * kLanes, _mm256_min_ps(high, _mm256_max_ps(low, sum[p])));
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
      const Vec weight = _mm256_loadu_ps(m.weights + (3 * ky + kx) * kLanes);
#pragma GCC unroll 8
      for (int p = 0; p < kPixels; ++p) {
        const Vec value = _mm256_loadu_ps(x + p * step + kx * kPanel);
        sum[p] = _mm256_fmadd_ps(value, weight, sum[p]);
      }
    }
  }
  store(m, sum, y);
}

// Any other kernel, one pixel at a time.
void pixel_any(const Window& m, const float* x, float* y) {
  Vec sum[1] = {m.bias};
  const std::uint16_t* w = m.halves;
  for (std::int32_t ky = 0; ky < m.a.kernel_h; ++ky, x += m.s.x_row_elems) {
    for (std::int32_t kx = 0; kx < m.a.kernel_w; ++kx, w += kLanes) {
      const Vec value = _mm256_loadu_ps(x + std::ptrdiff_t{kx} * kPanel);
      sum[0] = _mm256_fmadd_ps(value, load_half(w), sum[0]);
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
        m, x + std::ptrdiff_t{done} * m.a.stride_w * kPanel, y + std::ptrdiff_t{done} * kLanes);
    done += count;
  }
}

void row_any(const Window& m, const float* x, float* y) {
  for (std::int32_t ox = 0; ox < m.a.out_w; ++ox) {
    pixel_any(m, x + std::ptrdiff_t{ox} * m.a.stride_w * kPanel, y + std::ptrdiff_t{ox} * kLanes);
  }
}

// `half` 0: the lower 8 channels of the panel, 1: the upper.
void slide_half(const InvertedResidualArgs& a, const Slide<float>& s, std::int32_t half) {
  const std::ptrdiff_t taps = std::ptrdiff_t{a.kernel_h} * a.kernel_w;
  const std::int32_t block = s.block + half;
  const std::uint16_t* halves = a.slide.weights + block * taps * kLanes;
  const bool is_3x3 = a.kernel_h == 3 && a.kernel_w == 3;
  float weights[9 * kLanes];
  for (std::int32_t tap = 0; is_3x3 && tap < 9; ++tap) {
    _mm256_storeu_ps(weights + tap * kLanes, load_half(halves + tap * kLanes));
  }
  const Window m{a, s, weights, halves, load_half(a.slide.bias + block * kLanes)};
  float* band = band_at(a, s) + half * band_plane(a, s);
  for (std::int32_t row = 0; row < s.rows; ++row) {
    const float* x = s.x + row * a.stride_h * s.x_row_elems + std::ptrdiff_t{half} * kLanes;
    float* y = band + std::ptrdiff_t{row} * a.out_w * kLanes;
    is_3x3 ? row_3x3(m, x, y) : row_any(m, x, y);
  }
}

struct Tier2 {
  static void multiply(const ProductArgs& args) { multiply_panels(args); }

  static void slide(const InvertedResidualArgs& a, const Slide<float>& s) {
    slide_half(a, s, 0);
    if (s.blocks > 1) {
      slide_half(a, s, 1);
    }
  }

  static void load(const float* x, float* y) { _mm256_storeu_ps(y, _mm256_loadu_ps(x)); }
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) {
  InvertedResidual<FloatStrips<Tier2>>(a).run();
}

}  // namespace mien::kernels::avx2
