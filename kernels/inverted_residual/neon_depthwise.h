// The depthwise part of a fused block on NEON: 3x3 windows with the tiles of the depthwise kernel,
// others one pixel at a time. A pixel has kPanel contiguous channels in the strip, kYPixel in the
// band.
#pragma once

#include "kernels/depthwise/neon_window.h"
#include "kernels/inverted_residual/strips.h"

namespace mien::kernels::MIEN_TIER {
namespace {

template <class N, int kYPixel>
void depthwise_any(const InvertedResidualArgs& a, const Taps<N>& taps, const Rows<N>& at,
                   std::int32_t rows) {
  for (std::int32_t i = 0; i < rows * a.out_w; ++i) {
    const std::int32_t oy = i / a.out_w, ox = i % a.out_w;
    const auto* x = at.x + oy * a.stride_h * at.x_row + std::ptrdiff_t{ox} * a.stride_w * kPanel;
    auto* y = at.y + oy * at.y_row + std::ptrdiff_t{ox} * kYPixel;
    typename N::Vec sums[N::kVecs];
    MIEN_UNROLLED for (int v = 0; v < N::kVecs; ++v) {
      typename N::Vec sum = N::load(taps.biases + v * N::kLanes);
      const std::uint16_t* w = taps.weights + v * taps.vec_elems;
      for (std::int32_t ky = 0; ky < a.kernel_h; ++ky) {
        for (std::int32_t kx = 0; kx < a.kernel_w; ++kx, w += kBlock) {
          const auto* input = x + ky * at.x_row + kx * kPanel + v * N::kLanes;
          sum = N::fma(sum, N::load(input), N::weights(w));
        }
      }
      sums[v] = sum;
    }
    taps.finish.store(y, sums);
  }
}

template <class N, int kYPixel>
void depthwise_rows(const InvertedResidualArgs& a, const Taps<N>& taps, const Rows<N>& at,
                    std::int32_t rows) {
  const bool is_3x3 = a.kernel_h == 3 && a.kernel_w == 3 && a.stride_h == a.stride_w;
  if (is_3x3 && a.stride_h == 1) {
    all_whole_outputs<N, 1, kPanel, kYPixel>(taps, at, rows, a.out_w);
  } else if (is_3x3 && a.stride_h == 2) {
    all_whole_outputs<N, 2, kPanel, kYPixel>(taps, at, rows, a.out_w);
  } else {
    depthwise_any<N, kYPixel>(a, taps, at, rows);
  }
}

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
