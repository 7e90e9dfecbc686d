// Quantized weights as in quantize_weights.h and quantize_to_int8.h.
#pragma once

#include "apps/conformance/families/common.h"

namespace mien::conformance {

// Index of element k of output o's sum in panels of quantized weights. `group`: adjacent elements
// in a lane, 2 of 16 bits or 4 of 8.
inline std::size_t index_in_panels(int outputs, int reduction, int group, int o, int k) {
  const int width = outputs - o / 16 * 16 < 16 ? 8 : 16, together = 16 * group / width;
  return as_size(o / 16 * 16 * reduction + k / together * 16 * group + o % 16 * together +
                 k % together);
}

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

struct Int8Weights {
  Int8Weights() = default;
  Int8Weights(const std::vector<std::uint16_t>& panels, int outputs, int inputs);

  // w / scale before rounding, in the order of `quads`.
  std::vector<double> quotients;
  std::vector<std::uint8_t> quads;  // two's complement
  std::vector<float> scales, sums;
};

}  // namespace mien::conformance
