// The reference kernel of matrix_vector.
#include <cstddef>

#include "kernels/families.h"

namespace mien::kernels::ref {

void matrix_vector(const MatrixVectorArgs& a) {
  for (std::int32_t row = 0; row < a.rows; ++row) {
    const float* w = a.weights + std::ptrdiff_t{row} * a.columns;
    double sum = 0.0;
    for (std::int32_t k = 0; k < a.columns; ++k) {
      sum += static_cast<double>(w[k]) * static_cast<double>(a.x[k]);
    }
    a.y[row] = static_cast<float>(sum);
  }
}

}  // namespace mien::kernels::ref
