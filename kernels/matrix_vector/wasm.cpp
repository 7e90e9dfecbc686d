// The wasm tier of matrix_vector.
#include "kernels/common/wasm.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

// Loads the last `count` floats, 1..3, filled up with zeros; does not read beyond them.
Vec load_rest(const float* at, std::int32_t count) {
  Vec rest = wasm_v128_load32_zero(at);
  if (count > 1) {
    rest = wasm_v128_load32_lane(at + 1, rest, 1);
  }
  if (count > 2) {
    rest = wasm_v128_load32_lane(at + 2, rest, 2);
  }
  return rest;
}

// Rows of W computed together: their sums are independent, and x is loaded once for all of them.
template <int kRows>
void rows_times_vector(const float* w, const float* x, std::int32_t columns, float* y) {
  Vec sum[kRows];
  for (Vec& one : sum) {
    one = splat(0.0f);
  }
  std::int32_t k = 0;
  for (; k + kLanes <= columns; k += kLanes) {
    const Vec value = load(x + k);
    for (int r = 0; r < kRows; ++r) {
      const float* row = w + std::ptrdiff_t{r} * columns;
      sum[r] = add_product(sum[r], load(row + k), value);
    }
  }
  if (k < columns) {
    const Vec value = load_rest(x + k, columns - k);
    for (int r = 0; r < kRows; ++r) {
      const float* row = w + std::ptrdiff_t{r} * columns;
      sum[r] = add_product(sum[r], load_rest(row + k, columns - k), value);
    }
  }
  for (int r = 0; r < kRows; ++r) {
    y[r] = wasm_f32x4_extract_lane(sum_of_lanes(sum[r]), 0);
  }
}

}  // namespace

void matrix_vector(const MatrixVectorArgs& a) {
  std::int32_t row = 0;
  const auto weights = [&] { return a.weights + std::ptrdiff_t{row} * a.columns; };
  for (; row + 4 <= a.rows; row += 4) {
    rows_times_vector<4>(weights(), a.x, a.columns, a.y + row);
  }
  for (; row + 2 <= a.rows; row += 2) {
    rows_times_vector<2>(weights(), a.x, a.columns, a.y + row);
  }
  if (row < a.rows) {
    rows_times_vector<1>(weights(), a.x, a.columns, a.y + row);
  }
}

}  // namespace mien::kernels::wasm
