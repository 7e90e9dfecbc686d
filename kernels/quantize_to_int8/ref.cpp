// The reference kernel of quantize_to_int8.
#include "kernels/common/ref_quantized_panels.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

double scale_of(const QuantizedPanels& w, std::int32_t o) {
  double largest = 0.0;
  for (std::int32_t k = 0; k < w.inputs; ++k) {
    largest = std::max(largest, std::abs(w.at(o, k)));
  }
  return largest / kInt8WeightMax;
}

}  // namespace

void quantize_to_int8(const QuantizeToInt8Args& a) {
  const QuantizedPanels w{
      a.weights, a.out_blocks * kBlock, a.in_blocks * kBlock, (a.in_blocks + 1) / 2 * kPanel, 4,
      a.panel};
  for (std::int32_t o = 0; o < w.outputs; ++o) {
    const double scale = scale_of(w, o);
    double sum = 0.0;
    for (std::int32_t k = 0; k < w.reduction; ++k) {
      const double q = scale > 0.0 ? std::nearbyint(w.at(o, k) / scale) : 0.0;
      a.quads[w.place(o, k)] = static_cast<std::int8_t>(q);
      sum += q;
    }
    a.scales[o] = static_cast<float>(scale);
    a.sums[o] = static_cast<float>(sum);
  }
}

}  // namespace mien::kernels::ref
