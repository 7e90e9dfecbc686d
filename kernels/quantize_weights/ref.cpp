// The reference kernel of quantize_weights.
#include "kernels/common/ref.h"
#include "kernels/families.h"
#include "kernels/quantize_weights/quantized_scale.h"

namespace mien::kernels::ref {
namespace {

struct Weights {
  const QuantizeWeightsArgs& a;
  [[nodiscard]] std::int32_t reduction() const { return a.in_blocks * kBlock; }
  [[nodiscard]] double at(std::int32_t o, std::int32_t k) const {
    return panel_weight(a.weights, a.out_blocks * kBlock, reduction(), o, k);
  }
};

double step_of(const Weights& w, std::int32_t o) {
  double above = 0.0, below = 0.0, largest = 0.0;
  for (std::int32_t k = 0; k < w.reduction(); ++k) {
    above += std::max(w.at(o, k), 0.0);
    below += std::max(-w.at(o, k), 0.0);
    largest = std::max(largest, std::abs(w.at(o, k)));
  }
  const double reach = w.a.is_signed ? above + below : std::max(above, below);
  return std::max(reach * static_cast<double>(scale_of_reach(w.a)),
                  largest * static_cast<double>(kScaleOfLargest));
}

// Index of q[o, k] in `pairs`.
std::ptrdiff_t place(const Weights& w, std::int32_t o, std::int32_t k) {
  const std::int32_t first = o / kPanel * kPanel;
  const std::int32_t width = std::min(kPanel, w.a.out_blocks * kBlock - first);
  const std::int32_t together = 2 * kPanel / width;  // adjacent elements of the sum
  return std::ptrdiff_t{first} * w.reduction() + std::ptrdiff_t{k} / together * 2 * kPanel +
         (o - first) * together + k % together;
}

}  // namespace

void quantize_weights(const QuantizeWeightsArgs& a) {
  const Weights w{a};
  for (std::int32_t o = 0; o < a.out_blocks * kBlock; ++o) {
    const double step = step_of(w, o);
    a.scales[o] = static_cast<float>(step);
    for (std::int32_t k = 0; k < w.reduction(); ++k) {
      const double q = step > 0.0 ? std::nearbyint(w.at(o, k) / step) : 0.0;
      a.pairs[place(w, o, k)] = static_cast<std::int16_t>(q);
    }
  }
}

}  // namespace mien::kernels::ref
