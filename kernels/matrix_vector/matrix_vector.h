// Matrix-vector product in fp32: y = W x. For filters and transforms that need more than fp16.
//
// weights: [rows, columns]; x: [columns]; y: [rows], not overlapping. Any sizes, no padding.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct MatrixVectorArgs {
  static constexpr std::string_view kFamily = "matrix_vector";
  const float* weights;
  const float* x;
  float* y;
  std::int32_t rows;
  std::int32_t columns;
};

}  // namespace mien::kernels
