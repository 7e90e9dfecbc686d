// Blend shapes: many vectors as weighted sums of the same few.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstring>

namespace mien::render {

using Lane = float __attribute__((vector_size(64)));  // 16 floats

constexpr int kBlock = 64;  // numbers of a shape that lie together

// out [rows,n] = weights [rows,shapes] * basis [n/64,shapes,64], with Rows of the output in
// registers.
template <int Rows>
void blend_rows(const float* weights, const float* basis, int shapes, size_t n, float* out) {
  for (size_t at = 0; at < n; at += 16) {
    const float* block = basis + at / kBlock * kBlock * size_t(shapes) + at % kBlock;
    Lane sum[Rows] = {};
    for (int s = 0; s < shapes; ++s) {
      Lane shape;
      std::memcpy(&shape, block + s * kBlock, sizeof shape);
      for (int r = 0; r < Rows; ++r) sum[r] += shape * weights[r * shapes + s];
    }
    for (int r = 0; r < Rows; ++r) std::memcpy(out + size_t(r) * n + at, &sum[r], sizeof(Lane));
  }
}

// The same for any number of rows.
inline void blend_shapes(const float* weights, const float* basis, int rows, int shapes, int blocks,
                         float* out) {
  const size_t n = size_t(blocks) * kBlock;
  int r = 0;
  for (; r + 16 <= rows; r += 16)
    blend_rows<16>(weights + r * shapes, basis, shapes, n, out + size_t(r) * n);
  for (; r + 4 <= rows; r += 4)
    blend_rows<4>(weights + r * shapes, basis, shapes, n, out + size_t(r) * n);
  for (; r < rows; ++r) blend_rows<1>(weights + r * shapes, basis, shapes, n, out + size_t(r) * n);
}

}  // namespace mien::render
