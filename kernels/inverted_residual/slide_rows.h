// The depthwise part of tiers that have a vector for the channels of a strip's panel, or for half
// of them: a row of outputs in parts of up to 8 pixels. Such a tier brings a Window:
//
//   Value, Vec                the strip's and the band's numbers, and several of them
//   kStrip, kBand             values from one pixel to the next, in both
//   a                         the block's arguments
//   x_row_elems               from row to row of the strip
//   bias                      where all sums begin
//   load(const Value*), fma(Vec sum, Vec value, Vec weight)
//   weight(tap), any_weight(tap)   of a 3x3 kernel, which are at hand, and of any
//   store(Vec sum, Value*)    clamps it
#pragma once

#include <utility>

#include "kernels/inverted_residual/strips.h"

namespace mien::kernels {
namespace {

template <class Window>
class SlideRows {
 public:
  using Value = typename Window::Value;

  // `rows` rows of the strip from `x` on to rows of the band, from `y` on.
  static void run(const Window& m, std::int32_t rows, const Value* x, Value* y) {
    const bool is_3x3 = m.a.kernel_h == 3 && m.a.kernel_w == 3;
    for (std::int32_t row = 0; row < rows; ++row) {
      is_3x3 ? row_3x3(m, x, y) : row_any(m, x, y);
      x += m.a.stride_h * m.x_row_elems;
      y += std::ptrdiff_t{m.a.out_w} * Window::kBand;
    }
  }

 private:
  using Vec = typename Window::Vec;
  using Pixels = void (*)(const Window&, const Value*, Value*);
  static constexpr int kMostPixels = 8;

  template <int kPixels>
  static void pixels_3x3(const Window& m, const Value* x, Value* y) {
    const std::ptrdiff_t step = std::ptrdiff_t{m.a.stride_w} * Window::kStrip;
    Vec sum[kPixels];
    for (Vec& one : sum) {
      one = m.bias;
    }
#pragma GCC unroll 3
    for (int ky = 0; ky < 3; ++ky, x += m.x_row_elems) {
#pragma GCC unroll 3
      for (int kx = 0; kx < 3; ++kx) {
        const Vec weight = m.weight(3 * ky + kx);
#pragma GCC unroll 8
        for (int p = 0; p < kPixels; ++p) {
          const Vec value = Window::load(x + p * step + kx * Window::kStrip);
          sum[p] = Window::fma(sum[p], value, weight);
        }
      }
    }
#pragma GCC unroll 8
    for (int p = 0; p < kPixels; ++p) {
      m.store(sum[p], y + p * Window::kBand);
    }
  }

  // Any other kernel, one pixel at a time.
  static void pixel_any(const Window& m, const Value* x, Value* y) {
    Vec sum = m.bias;
    std::int32_t tap = 0;
    for (std::int32_t ky = 0; ky < m.a.kernel_h; ++ky, x += m.x_row_elems) {
      for (std::int32_t kx = 0; kx < m.a.kernel_w; ++kx, ++tap) {
        const Vec value = Window::load(x + std::ptrdiff_t{kx} * Window::kStrip);
        sum = Window::fma(sum, value, m.any_weight(tap));
      }
    }
    m.store(sum, y);
  }

  template <int... kLess>
  static Pixels pixels_of(std::int32_t count, std::integer_sequence<int, kLess...>) {
    static constexpr Pixels kAll[] = {&pixels_3x3<kLess + 1>...};
    return kAll[count - 1];
  }

  // In parts of nearly equal size.
  static void row_3x3(const Window& m, const Value* x, Value* y) {
    const std::int32_t w = m.a.out_w, parts = (w + kMostPixels - 1) / kMostPixels;
    for (std::int32_t i = 0, done = 0; i < parts; ++i) {
      const std::int32_t count = (w - done + parts - i - 1) / (parts - i);
      pixels_of(count, std::make_integer_sequence<int, kMostPixels>())(
          m, x + std::ptrdiff_t{done} * m.a.stride_w * Window::kStrip,
          y + std::ptrdiff_t{done} * Window::kBand);
      done += count;
    }
  }

  static void row_any(const Window& m, const Value* x, Value* y) {
    for (std::int32_t ox = 0; ox < m.a.out_w; ++ox) {
      pixel_any(m, x + std::ptrdiff_t{ox} * m.a.stride_w * Window::kStrip,
                y + std::ptrdiff_t{ox} * Window::kBand);
    }
  }
};

}  // namespace
}  // namespace mien::kernels
