// 3x3 windows that lie inside the map, 2x2 outputs at a time: the weights of the channels in
// registers, every input loaded once. Numbers are Floats, or Halves (common/neon_half.h).
#pragma once

#include "kernels/common/neon.h"

namespace mien::kernels::MIEN_TIER {

constexpr int kMaxOutputs = 4;  // of a tile

namespace {

struct Floats {
  using Value = float;
  using Vec = MIEN_TIER::Vec;
  static constexpr int kLanes = MIEN_TIER::kLanes;
// Vectors of channels that are worked on together: their 9 weights fill half of the registers.
#ifdef MIEN_NEON64
  static constexpr int kVecs = 2;
#else
  static constexpr int kVecs = 1;
#endif
  static Vec load(const float* at) { return vld1q_f32(at); }
  static void store(float* at, Vec x) { vst1q_f32(at, x); }
  static Vec weights(const std::uint16_t* at) { return load_half(at); }
  static Vec set(float x) { return splat(x); }
  static Vec fma(Vec sum, Vec a, Vec b) { return vfmaq_f32(sum, a, b); }
  static Vec clamped(Vec x, Vec low, Vec high) { return vminq_f32(vmaxq_f32(x, low), high); }
};

// What is the same for all outputs of kVecs vectors of channels.
template <class N>
struct Taps {
  const std::uint16_t* weights;  // [kernel_h][kernel_w][8]
  std::ptrdiff_t vec_elems;      // from those of one vector to those of the next
  typename N::Vec low, high;
  // Once for every sum of a tile: to load it costs no time, to copy it from register to register
  // would, as the units that multiply do that.
  typename N::Value biases[kMaxOutputs * N::kVecs * N::kLanes];

  Taps(const std::uint16_t* first_weights, std::ptrdiff_t weights_vec_elems,
       const std::uint16_t* bias, std::ptrdiff_t bias_vec_elems, typename N::Vec lowest,
       typename N::Vec highest)
      : weights(first_weights), vec_elems(weights_vec_elems), low(lowest), high(highest) {
    for (int i = 0; i < kMaxOutputs * N::kVecs; ++i) {
      N::store(biases + i * N::kLanes, N::weights(bias + i % N::kVecs * bias_vec_elems));
    }
  }
};

// The parameters of 3x3 windows, in registers but for the bias.
template <class N>
struct Window {
  typename N::Vec w[9][N::kVecs];
  typename N::Vec low, high;
  const typename N::Value* biases;

  [[gnu::always_inline]] explicit Window(const Taps<N>& taps)
      : low(taps.low), high(taps.high), biases(taps.biases) {
    MIEN_UNROLLED for (int i = 0; i < 9 * N::kVecs; ++i) {
      const int tap = i / N::kVecs, v = i % N::kVecs;
      w[tap][v] = N::weights(taps.weights + tap * kBlock + v * taps.vec_elems);
    }
  }
};

// Maps whose pixels are kXPixel and kYPixel values apart.
template <class N>
struct Rows {
  const typename N::Value* x;
  std::ptrdiff_t x_row;
  typename N::Value* y;
  std::ptrdiff_t y_row;
};

// The same address, of which gcc knows nothing: it would keep each sum of it and a stride in a
// register of its own, and run out of them. clang does not, and unrolls no loop with assembler in
// it.
template <class T>
[[gnu::always_inline]] inline T* opaque(T* at) {
#ifndef __clang__
  asm("" : "+r"(at));
#endif
  return at;
}

// Each input goes to the sums of all outputs whose windows it lies in.
template <class N, int kRows, int kColumns, int kStride, int kXPixel, int kYPixel>
[[gnu::always_inline]] inline void tile(const Window<N>& window, const typename N::Value* x,
                                        std::ptrdiff_t x_row, typename N::Value* y,
                                        std::ptrdiff_t y_row) {
  constexpr int kVecs = N::kVecs;
  typename N::Vec sums[kRows * kColumns][kVecs];
  MIEN_UNROLLED for (int i = 0; i < kRows * kColumns * kVecs; ++i) {
    sums[i / kVecs][i % kVecs] = N::load(window.biases + i * N::kLanes);
  }
  MIEN_UNROLLED for (int i = 0; i < (kRows - 1) * kStride + 3; ++i) {
    const typename N::Value* row = opaque(x + i * x_row);
    MIEN_UNROLLED for (int j = 0; j < (kColumns - 1) * kStride + 3; ++j) {
      typename N::Vec input[kVecs];
      MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
        input[v] = N::load(row + j * kXPixel + v * N::kLanes);
      }
      MIEN_UNROLLED for (int output = 0; output < kRows * kColumns; ++output) {
        const int ky = i - output / kColumns * kStride, kx = j - output % kColumns * kStride;
        if (ky >= 0 && ky < 3 && kx >= 0 && kx < 3) {
          MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
            sums[output][v] = N::fma(sums[output][v], input[v], window.w[3 * ky + kx][v]);
          }
        }
      }
    }
  }
  MIEN_UNROLLED for (int i = 0; i < kRows; ++i) {
    typename N::Value* row = opaque(y + i * y_row);
    MIEN_UNROLLED for (int j = 0; j < kColumns * kVecs; ++j) {
      const typename N::Vec sum = sums[i * kColumns + j / kVecs][j % kVecs];
      N::store(row + j / kVecs * kYPixel + j % kVecs * N::kLanes,
               N::clamped(sum, window.low, window.high));
    }
  }
}

// kRows rows of `columns` outputs.
template <class N, int kRows, int kStride, int kXPixel, int kYPixel>
[[gnu::noinline]] void whole_outputs(const Taps<N>& taps, const Rows<N>& at, std::int32_t columns) {
  const Window<N> window(taps);
  const typename N::Value* x = at.x;
  typename N::Value* y = at.y;
  const std::ptrdiff_t x_row = at.x_row, y_row = at.y_row;
  for (std::int32_t left = columns / 2; left > 0; --left) {
    tile<N, kRows, 2, kStride, kXPixel, kYPixel>(window, x, x_row, y, y_row);
    x += 2 * kStride * kXPixel;
    y += 2 * kYPixel;
  }
  if (columns % 2 != 0) {
    tile<N, kRows, 1, kStride, kXPixel, kYPixel>(window, x, x_row, y, y_row);
  }
}

// `rows` rows of `columns` outputs.
template <class N, int kStride, int kXPixel, int kYPixel>
void all_whole_outputs(const Taps<N>& taps, Rows<N> at, std::int32_t rows, std::int32_t columns) {
  for (; rows >= 2; rows -= 2, at.x += 2 * kStride * at.x_row, at.y += 2 * at.y_row) {
    whole_outputs<N, 2, kStride, kXPixel, kYPixel>(taps, at, columns);
  }
  if (rows > 0) {
    whole_outputs<N, 1, kStride, kXPixel, kYPixel>(taps, at, columns);
  }
}

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
