// Quantized weights as in quantize_weights.h and quantize_to_int8.h.
#pragma once

#include <algorithm>

#include "apps/conformance/families/common.h"

namespace mien::conformance {

// Index of element k of output o's sum in panels of `panel` outputs of quantized weights. `group`:
// adjacent elements in a lane, 2 of 16 bits or 4 of 8.
inline std::size_t index_in_panels(int panel, int outputs, int reduction, int group, int o, int k) {
  const int first = o / panel * panel, width = std::min(panel, outputs - first);
  const int together = 16 * group / width;
  return as_size(first * reduction + k / together * 16 * group + (o - first) * together +
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
  // `to_panel`: outputs of a panel of `quads`.
  Int8Weights(const std::vector<std::uint16_t>& panels, int outputs, int inputs, int to_panel);

  // w / scale before rounding, in the order of `quads`.
  std::vector<double> quotients;
  std::vector<std::uint8_t> quads;  // two's complement
  std::vector<float> scales, sums;
  int panel = 0;
};

}  // namespace mien::conformance
