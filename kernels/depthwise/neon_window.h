// 3x3 windows inside the map, computed as tiles of 2x2 outputs: the weights of the channels stay in
// registers, and every input is loaded once. Values are Floats, or those of
// inverted_residual/neon_half_strips.h.
#pragma once

#include "kernels/common/neon.h"

namespace mien::kernels::MIEN_TIER {

constexpr int kMaxOutputs = 4;  // outputs of a tile

namespace {

// Clamps and stores the kVecs vectors of an output.
template <class N>
struct Clamp {
  using Output = typename N::Value;
  typename N::Vec low, high;
  [[gnu::always_inline]] void store(Output* y, const typename N::Vec (&sums)[N::kVecs]) const {
    MIEN_UNROLLED for (int v = 0; v < N::kVecs; ++v) {
      N::store(y + v * N::kLanes, N::clamped(sums[v], low, high));
    }
  }
};

struct Floats {
  using Value = float;
  using Vec = MIEN_TIER::Vec;
  using Finish = Clamp<Floats>;
  static constexpr int kLanes = MIEN_TIER::kLanes;
// Number of channel vectors computed together: their 9 weights fill half of the registers.
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

// Parameters common to all outputs of kVecs vectors of channels.
template <class N>
struct Taps {
  const std::uint16_t* weights;  // [kernel_h][kernel_w][8]
  std::ptrdiff_t vec_elems;      // distance between vectors
  typename N::Finish finish;
  // One copy per sum of a tile: a load costs no time, but a copy between registers would occupy the
  // units that multiply.
  typename N::Value biases[kMaxOutputs * N::kVecs * N::kLanes];

  Taps(const std::uint16_t* first_weights, std::ptrdiff_t weights_vec_elems,
       const std::uint16_t* bias, std::ptrdiff_t bias_vec_elems, const typename N::Finish& by)
      : weights(first_weights), vec_elems(weights_vec_elems), finish(by) {
    for (int i = 0; i < kMaxOutputs * N::kVecs; ++i) {
      N::store(biases + i * N::kLanes, N::weights(bias + i % N::kVecs * bias_vec_elems));
    }
  }
};

// The parameters of 3x3 windows, in registers except for the bias.
template <class N>
struct Window {
  typename N::Vec w[9][N::kVecs];
  typename N::Finish finish;
  const typename N::Value* biases;

  [[gnu::always_inline]] explicit Window(const Taps<N>& taps)
      : finish(taps.finish), biases(taps.biases) {
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
  typename N::Finish::Output* y;
  std::ptrdiff_t y_row;
};

// Returns the same address, opaque to gcc, which would otherwise keep each sum of the address and a
// stride in its own register and run out of registers. clang does not, and it does not unroll loops
// that contain inline assembly.
template <class T>
[[gnu::always_inline]] inline T* opaque(T* at) {
#ifndef __clang__
  asm("" : "+r"(at));
#endif
  return at;
}

// A tile of outputs and the inputs of their windows.
template <int kRows, int kColumns, int kStride, int kXPixel>
struct TileShape {
  static constexpr int kOutputs = kRows * kColumns, kOutputColumns = kColumns;
  static constexpr int kStep = kStride, kPixel = kXPixel;
  static constexpr int kHeight = (kRows - 1) * kStride + 3, kWidth = (kColumns - 1) * kStride + 3;
};

template <class N>
struct Pixel {
  typename N::Vec vecs[N::kVecs];
  [[gnu::always_inline]] explicit Pixel(const typename N::Value* x) {
    MIEN_UNROLLED for (int v = 0; v < N::kVecs; ++v) { vecs[v] = N::load(x + v * N::kLanes); }
  }
};

// Adds inputs kInput and the following to the sums of all outputs whose windows contain them. `row`
// is the row of `input`. The next input is loaded first, because CPUs that execute in order wait
// for a load before its use.
template <class N, class Shape, int kInput = 0>
[[gnu::always_inline]] inline void add_inputs(const Window<N>& window, const typename N::Value* row,
                                              std::ptrdiff_t x_row, const Pixel<N>& input,
                                              typename N::Vec (&sums)[Shape::kOutputs][N::kVecs]) {
  constexpr int kY = kInput / Shape::kWidth, kX = kInput % Shape::kWidth;
  const auto add = [&] {
    MIEN_UNROLLED for (int output = 0; output < Shape::kOutputs; ++output) {
      const int ky = kY - output / Shape::kOutputColumns * Shape::kStep;
      const int kx = kX - output % Shape::kOutputColumns * Shape::kStep;
      if (ky >= 0 && ky < 3 && kx >= 0 && kx < 3) {
        MIEN_UNROLLED for (int v = 0; v < N::kVecs; ++v) {
          sums[output][v] = N::fma(sums[output][v], input.vecs[v], window.w[3 * ky + kx][v]);
        }
      }
    }
  };
  if constexpr (kInput + 1 == Shape::kHeight * Shape::kWidth) {
    add();
  } else {
    if constexpr (kX + 1 == Shape::kWidth) {
      row = opaque(row + x_row);
    }
    const Pixel<N> next(row + (kX + 1) % Shape::kWidth * Shape::kPixel);
    add();
    add_inputs<N, Shape, kInput + 1>(window, row, x_row, next, sums);
  }
}

template <class N, int kRows, int kColumns, int kStride, int kXPixel, int kYPixel>
[[gnu::always_inline]] inline void tile(const Window<N>& window, const typename N::Value* x,
                                        std::ptrdiff_t x_row, typename N::Finish::Output* y,
                                        std::ptrdiff_t y_row) {
  using Shape = TileShape<kRows, kColumns, kStride, kXPixel>;
  typename N::Vec sums[Shape::kOutputs][N::kVecs];
  MIEN_UNROLLED for (int i = 0; i < Shape::kOutputs * N::kVecs; ++i) {
    sums[i / N::kVecs][i % N::kVecs] = N::load(window.biases + i * N::kLanes);
  }
  add_inputs<N, Shape>(window, opaque(x), x_row, Pixel<N>(x), sums);
  MIEN_UNROLLED for (int i = 0; i < kRows; ++i) {
    typename N::Finish::Output* row = opaque(y + i * y_row);
    MIEN_UNROLLED for (int j = 0; j < kColumns; ++j) {
      window.finish.store(row + j * kYPixel, sums[i * kColumns + j]);
    }
  }
}

// Computes kRows rows of `columns` outputs.
template <class N, int kRows, int kStride, int kXPixel, int kYPixel>
[[gnu::noinline]] void whole_outputs(const Taps<N>& taps, const Rows<N>& at, std::int32_t columns) {
  const Window<N> window(taps);
  const typename N::Value* x = at.x;
  typename N::Finish::Output* y = at.y;
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

// Computes `rows` rows of `columns` outputs.
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
