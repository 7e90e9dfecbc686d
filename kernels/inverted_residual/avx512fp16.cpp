// Strips and bands in half precision, 32 channels of a pixel together: a vector. The depthwise part
// takes up to 8 output pixels of a row at once.
#include <utility>

#include "kernels/common/avx512.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/avx512fp16_product.h"
#include "kernels/inverted_residual/strips.h"

namespace mien::kernels::avx512fp16 {
namespace {

using Vec = __m512h;

constexpr int kMostPixels = 8;
static_assert(kSumsElems <= kInvertedResidualWideElems);

__m512i joined(__m256i low, __m256i high) {
  return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}

// 8 fp16 of each of up to 4 blocks, `step` apart.
Vec load_blocks(const Half* at, std::ptrdiff_t step, std::int32_t blocks) {
  const auto block = [&](std::int32_t i) {
    return i < blocks ? _mm_loadu_si128(reinterpret_cast<const __m128i*>(at + i * step))
                      : _mm_setzero_si128();
  };
  return _mm512_castsi512_ph(
      joined(_mm256_set_m128i(block(1), block(0)), _mm256_set_m128i(block(3), block(2))));
}

// The same of floats.
Vec narrowed(const float* at, std::ptrdiff_t step, std::int32_t blocks) {
  const auto pair = [&](std::int32_t i) {
    return i < blocks ? _mm512_cvtxps_ph(avx512::load_blocks(at + i * step, step, i + 1 < blocks))
                      : _mm256_setzero_ph();
  };
  return _mm512_castsi512_ph(joined(_mm256_castph_si256(pair(0)), _mm256_castph_si256(pair(2))));
}

struct Window {
  const InvertedResidualArgs& a;
  const Slide<Half>& s;
  const Vec* weights;  // 3x3: the nine
  Vec bias, low, high;
};

Vec weights_at(const InvertedResidualArgs& a, const Slide<Half>& s, std::int32_t tap) {
  const std::ptrdiff_t taps = std::ptrdiff_t{a.kernel_h} * a.kernel_w;
  return load_blocks(a.slide.weights + (s.block * taps + tap) * 8, taps * 8, s.blocks);
}

template <int kPixels>
void store(const Window& m, const Vec (&sum)[kPixels], Half* y) {
#pragma GCC unroll 8
  for (int p = 0; p < kPixels; ++p) {
    _mm512_storeu_ph(y + p * kHalves, _mm512_min_ph(m.high, _mm512_max_ph(m.low, sum[p])));
  }
}

template <int kPixels>
void pixels_3x3(const Window& m, const Half* x, Half* y) {
  const std::ptrdiff_t step = std::ptrdiff_t{m.a.stride_w} * kHalves;
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
        const Vec value = _mm512_loadu_ph(x + p * step + kx * kHalves);
        sum[p] = _mm512_fmadd_ph(value, m.weights[3 * ky + kx], sum[p]);
      }
    }
  }
  store(m, sum, y);
}

// Any other kernel, one pixel at a time.
void pixel_any(const Window& m, const Half* x, Half* y) {
  Vec sum[1] = {m.bias};
  for (std::int32_t ky = 0; ky < m.a.kernel_h; ++ky, x += m.s.x_row_elems) {
    for (std::int32_t kx = 0; kx < m.a.kernel_w; ++kx) {
      const Vec value = _mm512_loadu_ph(x + std::ptrdiff_t{kx} * kHalves);
      sum[0] = _mm512_fmadd_ph(value, weights_at(m.a, m.s, ky * m.a.kernel_w + kx), sum[0]);
    }
  }
  store(m, sum, y);
}

using Pixels = void (*)(const Window&, const Half*, Half*);

template <int... kLess>
Pixels pixels_of(std::int32_t count, std::integer_sequence<int, kLess...>) {
  static constexpr Pixels kAll[] = {&pixels_3x3<kLess + 1>...};
  return kAll[count - 1];
}

// A row in parts of nearly equal size.
void row_3x3(const Window& m, const Half* x, Half* y) {
  const std::int32_t w = m.a.out_w, parts = (w + kMostPixels - 1) / kMostPixels;
  for (std::int32_t i = 0, done = 0; i < parts; ++i) {
    const std::int32_t count = (w - done + parts - i - 1) / (parts - i);
    pixels_of(count, std::make_integer_sequence<int, kMostPixels>())(
        m, x + std::ptrdiff_t{done} * m.a.stride_w * kHalves, y + std::ptrdiff_t{done} * kHalves);
    done += count;
  }
}

void row_any(const Window& m, const Half* x, Half* y) {
  for (std::int32_t ox = 0; ox < m.a.out_w; ++ox) {
    pixel_any(m, x + std::ptrdiff_t{ox} * m.a.stride_w * kHalves, y + std::ptrdiff_t{ox} * kHalves);
  }
}

// The map in half precision and the band, [panel of 32 channels][pixel][32].
class HalfStrips {
 public:
  using Value = Half;
  static constexpr std::int32_t kPanel = kHalves;

  explicit HalfStrips(const InvertedResidualArgs& args)
      : a_(args),
        x_(reinterpret_cast<Half*>(args.narrow)),
        band_(reinterpret_cast<Half*>(args.band)) {}

  void begin(std::int32_t first, std::int32_t rows) {
    if (a_.expand.weights == nullptr) {
      return;
    }
    first_row_ = first;
    x_panel_elems_ = std::ptrdiff_t{rows} * a_.in_w * kHalves;
    const std::int32_t blocks = blocks_of(a_.in_c);
    for (std::int32_t block = 0; block < blocks; block += 4) {
      narrow_row(block, blocks - block, first, rows * a_.in_w, x_ + block / 4 * x_panel_elems_);
    }
  }

  void expand(const StripPart& part, std::int32_t row, std::int32_t rows, Half* y) const {
    const StripClamp clamp = clamp_of(a_.expand.activation);
    const std::ptrdiff_t channel = std::ptrdiff_t{part.first} * 8;
    HalfProduct product{};
    product.x = x_ + std::ptrdiff_t{row - first_row_} * a_.in_w * kHalves;
    product.x_panel_elems = x_panel_elems_;
    product.in_blocks = blocks_of(a_.in_c);
    product.pixels = rows * a_.in_w;
    product.weights = a_.expand.weights + channel * product.in_blocks * 8;
    product.bias = a_.expand.bias + channel;
    product.out_blocks = part.count;
    product.low = clamp.low;
    product.high = clamp.high;
    multiply_to_strip(product, {y, part.panel_elems, part.row_elems, a_.in_w});
  }

  void copy(const StripPart& part, std::int32_t row, std::int32_t rows, Half* y) const {
    for (std::int32_t block = 0; block < part.count; block += 4) {
      for (std::int32_t i = 0; i < rows; ++i) {
        narrow_row(part.first + block, part.count - block, row + i, a_.in_w,
                   y + block / 4 * part.panel_elems + i * part.row_elems);
      }
    }
  }

  void slide(const Slide<Half>& s) const {
    const bool is_3x3 = a_.kernel_h == 3 && a_.kernel_w == 3;
    Vec weights[9];
    for (std::int32_t tap = 0; is_3x3 && tap < 9; ++tap) {
      weights[tap] = weights_at(a_, s, tap);
    }
    const Window m{a_,
                   s,
                   weights,
                   load_blocks(a_.slide.bias + s.block * 8, 8, s.blocks),
                   _mm512_set1_ph(static_cast<_Float16>(s.clamp.low)),
                   _mm512_set1_ph(static_cast<_Float16>(s.clamp.high))};
    Half* y = band_ + (std::ptrdiff_t{s.block / 4} * s.band_rows + s.row) * a_.out_w * kHalves;
    for (std::int32_t row = 0; row < s.rows; ++row, y += std::ptrdiff_t{a_.out_w} * kHalves) {
      const Half* x = s.x + row * a_.stride_h * s.x_row_elems;
      is_3x3 ? row_3x3(m, x, y) : row_any(m, x, y);
    }
  }

  void project(std::int32_t first, std::int32_t rows) const {
    const StripClamp clamp = clamp_of(a_.project.activation);
    HalfProduct product{};
    product.x = band_;
    product.x_panel_elems = std::ptrdiff_t{rows} * a_.out_w * kHalves;
    product.in_blocks = blocks_of(a_.hidden_c);
    product.pixels = rows * a_.out_w;
    product.weights = a_.project.weights;
    product.bias = a_.project.bias;
    product.out_blocks = blocks_of(a_.out_c);
    product.low = clamp.low;
    product.high = clamp.high;
    MapRows to{};
    to.y = a_.y + std::ptrdiff_t{first} * a_.out_w * 8;
    to.plane_elems = std::ptrdiff_t{a_.out_h} * a_.out_w * 8;
    to.row_pixels = a_.out_w;
    if (a_.residual != nullptr) {
      const std::ptrdiff_t pixel =
          std::ptrdiff_t{first + a_.residual_top} * a_.residual_w + a_.residual_left;
      to.residual = a_.residual + pixel * 8;
      to.residual_plane_elems = std::ptrdiff_t{a_.residual_h} * a_.residual_w * 8;
      to.residual_row_elems = std::ptrdiff_t{a_.residual_w} * 8;
    }
    multiply_to_map(product, to, a_.wide);
  }

 private:
  static std::int32_t blocks_of(std::int32_t channels) { return (channels + 7) / 8; }

  // `pixels` pixels from the beginning of a row of the map on, up to 4 blocks of them.
  void narrow_row(std::int32_t block, std::int32_t blocks, std::int32_t row, std::int32_t pixels,
                  Half* y) const {
    const std::ptrdiff_t plane = std::ptrdiff_t{a_.in_h} * a_.in_w * 8;
    const float* x = a_.x + block * plane + std::ptrdiff_t{row} * a_.in_w * 8;
    for (std::int32_t p = 0; p < pixels; ++p, x += 8, y += kHalves) {
      _mm512_storeu_ph(y, narrowed(x, plane, blocks));
    }
  }

  const InvertedResidualArgs& a_;
  Half* x_;  // from row `first_row_` on
  Half* band_;
  std::int32_t first_row_ = 0;
  std::ptrdiff_t x_panel_elems_ = 0;
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) { InvertedResidual<HalfStrips>(a).run(); }

}  // namespace mien::kernels::avx512fp16
