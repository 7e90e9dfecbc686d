// The neon and neon32 tiers of matrix_vector.
#include "kernels/common/neon.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Rows of W computed together: their sums are independent, and x is loaded once for all of them.
template <int kRows>
void rows_times_vector(const float* w, const float* x, std::int32_t columns, float* y) {
  Vec sum[kRows];
  MIEN_UNROLLED for (Vec& one : sum) { one = splat(0.0f); }
  std::int32_t k = 0;
  for (; k + kLanes <= columns; k += kLanes) {
    const Vec value = vld1q_f32(x + k);
    MIEN_UNROLLED for (int r = 0; r < kRows; ++r) {
      sum[r] = fma(sum[r], vld1q_f32(w + std::ptrdiff_t{r} * columns + k), value);
    }
  }
  MIEN_UNROLLED for (int r = 0; r < kRows; ++r) {
    y[r] = vgetq_lane_f32(sum_of_lanes(sum[r]), 0);
    for (std::int32_t rest = k; rest < columns; ++rest) {
      y[r] += w[std::ptrdiff_t{r} * columns + rest] * x[rest];
    }
  }
}

}  // namespace

void matrix_vector(const MatrixVectorArgs& a) {
  std::int32_t row = 0;
  const auto weights = [&] { return a.weights + std::ptrdiff_t{row} * a.columns; };
  for (; row + 4 <= a.rows; row += 4) {
    rows_times_vector<4>(weights(), a.x, a.columns, a.y + row);
  }
  for (; row < a.rows; ++row) {
    rows_times_vector<1>(weights(), a.x, a.columns, a.y + row);
  }
}

}  // namespace mien::kernels::MIEN_TIER
