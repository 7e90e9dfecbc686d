// The depthwise part of a fused block, for tiers with a vector for the channels of a panel or of
// half a panel: rows of outputs in groups of up to 8 pixels. A tier supplies a Window:
//
//   Value, Vec                the element type of strip and band, and a vector of it
//   kStrip, kBand             distance in values between pixels of the strip and of the band
//   a                         the block's arguments
//   x_row_elems               distance between rows of the strip
//   bias                      initial value of all sums
//   load(const Value*), fma(Vec sum, Vec value, Vec weight)
//   weight(tap)
//   store(Vec sum, Value*)    clamps and stores
#pragma once

#include <utility>

#include "kernels/inverted_residual/strips.h"

namespace mien::kernels {
namespace {

template <class Window>
class DepthwiseRows {
 public:
  using Value = typename Window::Value;

  // Computes `rows` rows of the band at `y` from the strip at `x`.
  static void run(const Window& m, std::int32_t rows, const Value* x, Value* y) {
    const bool is_3x3 = m.a.kernel_h == 3 && m.a.kernel_w == 3;
    const Rows all = !is_3x3             ? &any_rows
                     : m.a.stride_w == 1 ? rows_of<1>(m.a.out_w, Sizes())
                     : m.a.stride_w == 2 ? rows_of<2>(m.a.out_w, Sizes())
                                         : &any_rows;
    all(m, rows, x, y);
  }

 private:
  using Vec = typename Window::Vec;
  using Rows = void (*)(const Window&, std::int32_t, const Value*, Value*);
  static constexpr int kMaxPixels = 8;
  using Sizes = std::make_integer_sequence<int, kMaxPixels>;

  // Chooses the group size with the fewest computed pixels, the larger if equal; the last group of
  // a row overlaps the previous one.
  template <int kStride, int... kLess>
  static Rows rows_of(std::int32_t w, std::integer_sequence<int, kLess...>) {
    static constexpr Rows kAll[] = {&rows_3x3<kLess + 1, kStride>...};
    const auto computed = [w](std::int32_t size) { return (w + size - 1) / size * size; };
    std::int32_t best = std::min(w, kMaxPixels);
    for (std::int32_t size = best; size > kMaxPixels / 2; --size) {
      best = computed(size) < computed(best) ? size : best;
    }
    return kAll[best - 1];
  }

  // Takes the window by value, so that stores cannot alias it.
  template <int kPixels, int kStride>
  static void rows_3x3(const Window& window, std::int32_t rows, const Value* x, Value* y) {
    const Window m = window;
    Vec weights[9];
    for (int tap = 0; tap < 9; ++tap) {
      weights[tap] = m.weight(tap);
    }
    const std::int32_t w = m.a.out_w;
    const std::ptrdiff_t stride = m.a.stride_h * m.x_row_elems;
    for (; rows > 0; --rows, x += stride, y += std::ptrdiff_t{w} * Window::kBand) {
      for (std::int32_t left = 0; left < w; left += kPixels) {
        const std::ptrdiff_t ox = std::min(left, w - kPixels);
        pixels_3x3<kPixels, kStride>(m, weights, x + ox * kStride * Window::kStrip,
                                     y + ox * Window::kBand);
      }
    }
  }

  template <int kPixels, int kStride>
  static void pixels_3x3(const Window& m, const Vec (&weights)[9], const Value* x, Value* y) {
    Vec sum[kPixels];
    for (Vec& one : sum) {
      one = m.bias;
    }
#pragma GCC unroll 3
    for (int ky = 0; ky < 3; ++ky, x += m.x_row_elems) {
#pragma GCC unroll 3
      for (int kx = 0; kx < 3; ++kx) {
#pragma GCC unroll 8
        for (int p = 0; p < kPixels; ++p) {
          const Vec value = Window::load(x + (p * kStride + kx) * Window::kStrip);
          sum[p] = Window::fma(sum[p], value, weights[3 * ky + kx]);
        }
      }
    }
#pragma GCC unroll 8
    for (int p = 0; p < kPixels; ++p) {
      m.store(sum[p], y + p * Window::kBand);
    }
  }

  // Any kernel size and stride, one pixel at a time.
  static void any_rows(const Window& m, std::int32_t rows, const Value* x, Value* y) {
    for (; rows > 0; --rows, x += m.a.stride_h * m.x_row_elems) {
      for (std::int32_t ox = 0; ox < m.a.out_w; ++ox, y += Window::kBand) {
        any_pixel(m, x + std::ptrdiff_t{ox} * m.a.stride_w * Window::kStrip, y);
      }
    }
  }

  static void any_pixel(const Window& m, const Value* x, Value* y) {
    Vec sum = m.bias;
    std::int32_t tap = 0;
    for (std::int32_t ky = 0; ky < m.a.kernel_h; ++ky, x += m.x_row_elems) {
      for (std::int32_t kx = 0; kx < m.a.kernel_w; ++kx, ++tap) {
        const Vec value = Window::load(x + std::ptrdiff_t{kx} * Window::kStrip);
        sum = Window::fma(sum, value, m.weight(tap));
      }
    }
    m.store(sum, y);
  }
};

}  // namespace
}  // namespace mien::kernels
