// Weights in fixed point, as quantize_weights.h wants them.
#pragma once

#include "apps/conformance/families/common.h"

namespace mien::conformance {

struct FixedPoint {
  // Of panels of fp16. `most`: of the integers that the weights are multiplied with.
  FixedPoint() = default;
  FixedPoint(const std::vector<std::uint16_t>& panels, int outputs, int inputs, int most,
             bool is_signed);

  // Before they are rounded: w / step. `pairs` has them in this order.
  std::vector<double> quotients;
  std::vector<std::uint16_t> pairs;  // two's complement
  std::vector<float> scales;
};

}  // namespace mien::conformance
