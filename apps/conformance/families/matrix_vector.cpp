// Cases of matrix_vector, with the expected results.
#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::MatrixVectorArgs;

// Limits magnitudes so that products do not overflow fp32.
std::vector<float> limited(std::vector<float> values) {
  for (float& one : values) {
    one = std::abs(one) > 1e15f ? one * 1e-13f : one;
  }
  return values;
}

Case make(RandomValues& random, int rows, int columns) {
  const std::vector<float> weights = limited(random.plain(rows * columns)),
                           x = limited(random.plain(columns));
  std::vector<Approx> y;
  for (int row = 0; row < rows; ++row) {
    Sum sum;
    for (int k = 0; k < columns; ++k) {
      sum.add(x[static_cast<std::size_t>(k)], weights[as_size(row * columns + k)]);
    }
    y.push_back(sum.total());
  }
  Case test;
  test.shape = times(rows, columns);
  test.buffers = {reads(weights), reads(x), writes(Element::kFloat, y)};
  test.bind = [=](const Addresses& buffers) {
    return arguments(
        MatrixVectorArgs{buffers.floats(0), buffers.floats(1), buffers.floats(2), rows, columns});
  };
  test.call = call<MatrixVectorArgs>;
  test.macs = static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(columns);
  return test;
}

}  // namespace

template <>
Case random_case<MatrixVectorArgs>(RandomValues& random) {
  return make(random, random.size(49), random.size(150));
}

template <>
Case typical_case<MatrixVectorArgs>(RandomValues& random) {
  return make(random, 26, 129);
}

}  // namespace mien::conformance
