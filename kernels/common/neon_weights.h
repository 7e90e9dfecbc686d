// Weights of a panel for tiles of sums: fp16 as stored, or converted to fp32 once for several
// tiles.
#pragma once

#include "kernels/common/neon.h"

namespace mien::kernels::MIEN_TIER {

// fp32 weights per conversion; they are on the stack, which must stay small.
constexpr std::int32_t kWidenedElems = 1280;

namespace {

// A tile is kVecs vectors of output channels wide: 4 (a panel) or 2 (half a panel). The number of
// pixels per tile depends on kVecs and on the number of registers.
#ifdef MIEN_NEON64
template <int kVecs>
constexpr int kTilePixels = kVecs == 4 ? 5 : 9;
#else
template <int kVecs>
constexpr int kTilePixels = kVecs == 4 ? 2 : 4;
#endif

[[gnu::always_inline]] inline Pair load_weights(const float* at) { return load_pair(at); }
[[gnu::always_inline]] inline Pair load_weights(const std::uint16_t* at) {
  return load_half_pair(at);
}

// Loads the weights of one input: kVecs vectors.
template <int kVecs, class T>
[[gnu::always_inline]] inline void load_row(const T* at, Vec (&row)[kVecs]) {
  MIEN_UNROLLED for (int v = 0; v < kVecs; v += 2) {
    const Pair pair = load_weights(at + v * kLanes);
    row[v] = pair.low;
    row[v + 1] = pair.high;
  }
}

// fp16 weights of a tile: their start and the distance between rows, which is 16 or 8 in a panel.
struct Halves {
  const std::uint16_t* first;
  std::int32_t stride;

  template <int kVecs>
  [[nodiscard]] std::int32_t row_elems() const {
    return stride;
  }
};
struct Widened {
  const float* first;

  template <int kVecs>
  [[nodiscard]] std::int32_t row_elems() const {
    return kVecs * kLanes;
  }
};

// Converts `rows` rows of `weights` to fp32, contiguously in `space`.
template <int kVecs>
inline Widened widen(const Halves& weights, std::ptrdiff_t rows, float* space) {
  const std::uint16_t* from = weights.first;
  const std::ptrdiff_t stride = weights.stride;
  float* to = space;
  for (std::ptrdiff_t k = 0; k < rows; ++k, from += stride, to += kVecs * kLanes) {
    for (int v = 0; v < kVecs; v += 2) {
      store_pair(to + v * kLanes, load_half_pair(from + v * kLanes));
    }
  }
  return {space};
}

// Adds the products of 4 inputs from pair kPair of their weights on, which `pair` has; the sums
// have kParts parts, each of every kParts-th input. The next pair is loaded first, because CPUs
// that execute in order wait for a load before its use.
template <int kPair, int kParts, int kPixels, int kVecs, class T>
[[gnu::always_inline]] inline void add_from_pair(const T* w, std::ptrdiff_t row_elems, Pair pair,
                                                 const Vec (&x)[kPixels],
                                                 Vec (&sums)[kParts][kPixels][kVecs]) {
  constexpr int kPairs = kVecs / 2, kLane = kPair / kPairs, kFirst = 2 * (kPair % kPairs);
  constexpr int kNext = kPair + 1;
  const auto add = [&](Vec weights, int v) {
    MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) {
      Vec& sum = sums[kLane % kParts][p][v];
      sum = fma_lane<kLane>(sum, weights, x[p]);
    }
  };
  if constexpr (kNext == kLanes * kPairs) {
    add(pair.low, kFirst);
    add(pair.high, kFirst + 1);
  } else {
    const Pair next = load_weights(w + kNext / kPairs * row_elems + 2 * kLanes * (kNext % kPairs));
    add(pair.low, kFirst);
    add(pair.high, kFirst + 1);
    add_from_pair<kNext>(w, row_elems, next, x, sums);
  }
}

// sums[p][v] += x[p][k] w[k][v] for the 4 contiguous inputs k of x. Pixels of x are `step` floats
// apart.
template <int kParts, int kPixels, int kVecs, class T>
[[gnu::always_inline]] inline void add_four_inputs(const float* x, std::ptrdiff_t step, const T* w,
                                                   std::ptrdiff_t row_elems,
                                                   Vec (&sums)[kParts][kPixels][kVecs]) {
  const Pair pair = load_weights(w);
  Vec inputs[kPixels];
  MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) { inputs[p] = vld1q_f32(x + p * step); }
  add_from_pair<0>(w, row_elems, pair, inputs, sums);
}

template <int kParts, int kPixels, int kVecs>
[[gnu::always_inline]] inline void start_sums(const std::uint16_t* bias,
                                              Vec (&sums)[kParts][kPixels][kVecs]) {
  Vec row[kVecs];
  load_row(bias, row);
  MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) {
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
      sums[0][p][v] = row[v];
      MIEN_UNROLLED for (int part = 1; part < kParts; ++part) { sums[part][p][v] = splat(0.0f); }
    }
  }
}

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
