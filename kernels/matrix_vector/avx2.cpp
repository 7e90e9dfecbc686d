// The avx2 tier of matrix_vector.
#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {
namespace {

// Rows of W computed together: their sums are independent, and x is loaded once for all of them.
template <int kRows>
void rows_times_vector(const float* w, const float* x, std::int32_t columns, float* y) {
  Vec sum[kRows];
  for (Vec& one : sum) {
    one = _mm256_setzero_ps();
  }
  std::int32_t k = 0;
  for (; k + kLanes <= columns; k += kLanes) {
    const Vec value = _mm256_loadu_ps(x + k);
    for (int r = 0; r < kRows; ++r) {
      const float* row = w + std::ptrdiff_t{r} * columns;
      sum[r] = _mm256_fmadd_ps(_mm256_loadu_ps(row + k), value, sum[r]);
    }
  }
  if (k < columns) {
    const __m256i mask = _mm256_castps_si256(lane_mask(k, columns));
    const Vec value = _mm256_maskload_ps(x + k, mask);
    for (int r = 0; r < kRows; ++r) {
      const float* row = w + std::ptrdiff_t{r} * columns;
      sum[r] = _mm256_fmadd_ps(_mm256_maskload_ps(row + k, mask), value, sum[r]);
    }
  }
  for (int r = 0; r < kRows; ++r) {
    y[r] = across(sum[r], [](Vec a, Vec b) { return _mm256_add_ps(a, b); });
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

}  // namespace mien::kernels::avx2
