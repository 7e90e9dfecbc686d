// Panels of quantized weights, for reference kernels.
#pragma once

#include "kernels/common/ref.h"

namespace mien::kernels::ref {

// fp16 weights of panels, whose reduction is padded with zeros.
struct QuantizedPanels {
  const std::uint16_t* weights;
  std::int32_t outputs, inputs, reduction;
  std::int32_t group;           // adjacent elements of the sum in a lane: 2 of 16 bits, 4 of 8
  std::int32_t panel = kPanel;  // outputs of a panel of quantized weights

  [[nodiscard]] double at(std::int32_t o, std::int32_t k) const {
    return k < inputs ? panel_weight(weights, outputs, inputs, o, k) : 0.0;
  }
  // Index of the quantized weight [o, k].
  [[nodiscard]] std::ptrdiff_t place(std::int32_t o, std::int32_t k) const {
    const std::int32_t first = o / panel * panel;
    const std::int32_t width = std::min(panel, outputs - first);
    const std::int32_t together = group * kPanel / width;
    return std::ptrdiff_t{first} * reduction + std::ptrdiff_t{k} / together * group * kPanel +
           (o - first) * together + k % together;
  }
};

}  // namespace mien::kernels::ref
