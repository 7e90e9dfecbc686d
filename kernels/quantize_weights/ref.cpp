// The reference kernel of quantize_weights.
#include "kernels/common/ref_quantized_panels.h"
#include "kernels/families.h"
#include "kernels/quantize_weights/quantized_scale.h"

namespace mien::kernels::ref {
namespace {

double step_of(const QuantizeWeightsArgs& a, const QuantizedPanels& w, std::int32_t o) {
  double above = 0.0, below = 0.0, largest = 0.0;
  for (std::int32_t k = 0; k < w.reduction; ++k) {
    above += std::max(w.at(o, k), 0.0);
    below += std::max(-w.at(o, k), 0.0);
    largest = std::max(largest, std::abs(w.at(o, k)));
  }
  const double reach = a.is_signed ? above + below : std::max(above, below);
  return std::max(reach * static_cast<double>(scale_of_reach(a)),
                  largest * static_cast<double>(kScaleOfLargest));
}

}  // namespace

void quantize_weights(const QuantizeWeightsArgs& a) {
  const std::int32_t inputs = a.in_blocks * kBlock;
  const QuantizedPanels w{a.weights, a.out_blocks * kBlock, inputs, inputs, 2};
  for (std::int32_t o = 0; o < w.outputs; ++o) {
    const double step = step_of(a, w, o);
    a.scales[o] = static_cast<float>(step);
    for (std::int32_t k = 0; k < w.reduction; ++k) {
      const double q = step > 0.0 ? std::nearbyint(w.at(o, k) / step) : 0.0;
      a.pairs[w.place(o, k)] = static_cast<std::int16_t>(q);
    }
  }
}

}  // namespace mien::kernels::ref
