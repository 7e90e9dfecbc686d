// Weights of a panel for tiles of sums: fp16 as stored, or converted to fp32 once for several
// tiles.
#pragma once

#include "kernels/common/wasm.h"

namespace mien::kernels::wasm {
namespace {

// fp16 weights of kVecs vectors of outputs: their start and the distance between inputs, which is
// 16 or 8 in a panel.
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

[[maybe_unused]] inline Vec load_weights(const std::uint16_t* at) { return load_half(at); }
[[maybe_unused]] inline Vec load_weights(const float* at) { return load(at); }

// fp32 weights per conversion, 16 KB on the stack: enough for two vectors of a product of 512
// inputs, the maximum of the published encoders.
inline constexpr std::int32_t kWidenedElems = 4096;

template <int kVecs>
[[maybe_unused]] constexpr bool fits_widened(std::ptrdiff_t rows) {
  return rows * kVecs * kLanes <= kWidenedElems;
}

template <int kVecs>
[[maybe_unused]] inline Widened widen(const Halves& weights, std::ptrdiff_t rows,
                                      float (&space)[kWidenedElems]) {
  const std::uint16_t* from = weights.first;
  float* to = space;
  for (std::ptrdiff_t k = 0; k < rows; ++k, from += weights.stride, to += kVecs * kLanes) {
    for (int v = 0; v < kVecs; ++v) {
      store(to + v * kLanes, load_half(from + v * kLanes));
    }
  }
  return {space};
}

// sums[p][v] += x[p] w[v], with pixels of x `step` floats apart.
template <int kPixels, int kVecs, class T>
inline void add_input(const float* x, std::ptrdiff_t step, const T* w,
                      Vec (&sums)[kPixels][kVecs]) {
  Vec row[kVecs];
  for (int v = 0; v < kVecs; ++v) {
    row[v] = load_weights(w + v * kLanes);
  }
  for (int p = 0; p < kPixels; ++p) {
    const Vec value = load_splat(x + p * step);
    for (int v = 0; v < kVecs; ++v) {
      sums[p][v] = add_product(sums[p][v], value, row[v]);
    }
  }
}

template <int kPixels, int kVecs>
inline void start_sums(const std::uint16_t* bias, Vec (&sums)[kPixels][kVecs]) {
  for (int v = 0; v < kVecs; ++v) {
    const Vec start = load_half(bias + v * kLanes);
    for (int p = 0; p < kPixels; ++p) {
      sums[p][v] = start;
    }
  }
}

}  // namespace
}  // namespace mien::kernels::wasm
