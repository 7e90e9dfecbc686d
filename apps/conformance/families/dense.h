// Outputs of packed panels, for fully connected, causal convolution and LSTM layers.
#pragma once

#include "apps/conformance/families/common.h"

namespace mien::conformance {

// bias[o] + sum of inputs times panel weights; `inputs` are in the order of the panels.
[[nodiscard]] inline Approx dense_output(const std::vector<float>& inputs,
                                         const std::vector<std::uint16_t>& panels,
                                         const std::vector<std::uint16_t>& bias, int outputs, int o,
                                         const Arithmetic& arithmetic) {
  Sum sum(arithmetic);
  sum.add(widened(bias[static_cast<std::size_t>(o)]));
  const int reduction = static_cast<int>(inputs.size());
  for (int k = 0; k < reduction; ++k) {
    sum.add(inputs[static_cast<std::size_t>(k)], panel_weight(panels, outputs, reduction, o, k));
  }
  return sum.total();
}

}  // namespace mien::conformance
