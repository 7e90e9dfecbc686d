// Quantized weights as in quantize_weights.h.
#pragma once

#include "apps/conformance/families/common.h"

namespace mien::conformance {

struct QuantizedWeights {
  // `max_value`: maximum magnitude of the integers that the weights are multiplied with.
  QuantizedWeights() = default;
  QuantizedWeights(const std::vector<std::uint16_t>& panels, int outputs, int inputs, int max_value,
                   bool is_signed);

  // w / scale before rounding, in the order of `pairs`.
  std::vector<double> quotients;
  std::vector<std::uint16_t> pairs;  // two's complement
  std::vector<float> scales;
};

}  // namespace mien::conformance
