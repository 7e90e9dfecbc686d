// The reference kernel of quantize_to_int8.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

struct Weights {
  const QuantizeToInt8Args& a;
  [[nodiscard]] std::int32_t inputs() const { return a.in_blocks * kBlock; }
  [[nodiscard]] std::int32_t reduction() const { return (a.in_blocks + 1) / 2 * kPanel; }
  // 0 in the padding.
  [[nodiscard]] double at(std::int32_t o, std::int32_t k) const {
    return k < inputs() ? panel_weight(a.weights, a.out_blocks * kBlock, inputs(), o, k) : 0.0;
  }
};

double scale_of(const Weights& w, std::int32_t o) {
  double largest = 0.0;
  for (std::int32_t k = 0; k < w.inputs(); ++k) {
    largest = std::max(largest, std::abs(w.at(o, k)));
  }
  return largest / kInt8WeightMax;
}

// Index of q[o, k] in `quads`.
std::ptrdiff_t place(const Weights& w, std::int32_t o, std::int32_t k) {
  const std::int32_t first = o / kPanel * kPanel;
  const std::int32_t width = std::min(kPanel, w.a.out_blocks * kBlock - first);
  const std::int32_t together = 4 * kPanel / width;  // adjacent elements of the sum
  return std::ptrdiff_t{first} * w.reduction() + std::ptrdiff_t{k} / together * 4 * kPanel +
         (o - first) * together + k % together;
}

}  // namespace

void quantize_to_int8(const QuantizeToInt8Args& a) {
  const Weights w{a};
  for (std::int32_t o = 0; o < a.out_blocks * kBlock; ++o) {
    const double scale = scale_of(w, o);
    double sum = 0.0;
    for (std::int32_t k = 0; k < w.reduction(); ++k) {
      const double q = scale > 0.0 ? std::nearbyint(w.at(o, k) / scale) : 0.0;
      a.quads[place(w, o, k)] = static_cast<std::int8_t>(q);
      sum += q;
    }
    a.scales[o] = static_cast<float>(scale);
    a.offsets[o] = static_cast<float>(-a.input_shift * sum);
  }
}

}  // namespace mien::kernels::ref
