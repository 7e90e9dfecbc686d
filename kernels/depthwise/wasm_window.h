// The sums of a 3x3 depthwise kernel for adjacent outputs of a row, for 4 channels.
#pragma once

#include "kernels/common/wasm.h"

namespace mien::kernels::wasm {
namespace {

// Adds the windows that begin at x, in a map whose pixels are kPixelElems floats apart. Loads each
// input once for all outputs whose windows contain it.
template <int kStride, int kPixelElems, int kColumns>
inline void add_windows_3x3(const float* x, std::ptrdiff_t row_elems, const Vec (&weights)[9],
                            Vec (&sums)[kColumns]) {
  for (int ky = 0; ky < 3; ++ky, x += row_elems) {
    for (int j = 0; j < (kColumns - 1) * kStride + 3; ++j) {
      const Vec input = load(x + j * kPixelElems);
      for (int column = 0; column < kColumns; ++column) {
        const int kx = j - column * kStride;
        if (kx >= 0 && kx < 3) {
          sums[column] = add_product(sums[column], input, weights[3 * ky + kx]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace mien::kernels::wasm
