// Cases of quantize_weights, with the expected results.
#include <cmath>

#include "apps/conformance/families/quantized_weights.h"

namespace mien::conformance {
namespace {

using kernels::QuantizeWeightsArgs;

struct Panels {
  const std::vector<std::uint16_t>& panels;
  int outputs, reduction;  // multiples of 8
  [[nodiscard]] double at(int o, int k) const {
    return panel_weight(panels, outputs, reduction, o, k);
  }
};

double scale_of(const Panels& w, int o, int max_value, bool is_signed) {
  double positive = 0.0, negative = 0.0, largest = 0.0;
  for (int k = 0; k < w.reduction; ++k) {
    const double one = w.at(o, k);
    (one > 0.0 ? positive : negative) += std::abs(one);
    largest = std::max(largest, std::abs(one));
  }
  const double sum = is_signed ? positive + negative : std::max(positive, negative);
  const double limit = 0x1p31 * (1.0 - 0x1p-10) - w.reduction * 0.5 * max_value;
  return std::max(largest / 32767.0, sum * max_value / limit);
}

std::size_t index_of(const Panels& w, int o, int k) {
  return index_in_panels(16, w.outputs, w.reduction, 2, o, k);
}

std::vector<Approx> expected_scales(const std::vector<float>& scales, int reduction) {
  std::vector<Approx> all;
  all.reserve(scales.size());
  for (const float scale : scales) {
    all.push_back(
        {static_cast<double>(scale), static_cast<double>(scale) * kUnit * (reduction + 8)});
  }
  return all;
}

std::vector<Approx> expected_pairs(const std::vector<double>& quotients) {
  std::vector<Approx> all;
  all.reserve(quotients.size());
  for (const double one : quotients) {
    // fp32 scales differ from those in double precision.
    all.push_back({one, one == 0.0 ? 0.0 : 0.5 + std::abs(one) * 0x1p-15});
  }
  return all;
}

Case make(RandomValues& random, int inputs, int outputs, bool is_signed, int max_value) {
  const std::vector<std::uint16_t> panels = random.panels(outputs, padded(inputs));
  const QuantizedWeights quantized(panels, outputs, inputs, max_value, is_signed);
  Case test;
  test.shape = std::to_string(inputs) + " to " + std::to_string(outputs) + ", up to " +
               std::to_string(max_value) + (is_signed ? ", signed" : "");
  test.buffers = {reads(panels), writes(Element::kInt16, expected_pairs(quantized.quotients)),
                  writes(Element::kFloat, expected_scales(quantized.scales, padded(inputs)))};
  test.bind = [=](const Addresses& buffers) {
    return arguments(QuantizeWeightsArgs{buffers.halves(0), buffers.int16s(1), buffers.floats(2),
                                         padded(inputs) / 8, padded(outputs) / 8, max_value,
                                         is_signed});
  };
  test.call = call<QuantizeWeightsArgs>;
  return test;
}

}  // namespace

QuantizedWeights::QuantizedWeights(const std::vector<std::uint16_t>& panels, int outputs,
                                   int inputs, int max_value, bool is_signed)
    : quotients(panels.size()), pairs(panels.size()) {
  const Panels w{panels, padded(outputs), padded(inputs)};
  for (int o = 0; o < w.outputs; ++o) {
    const double scale = scale_of(w, o, max_value, is_signed);
    scales.push_back(static_cast<float>(scale));
    for (int k = 0; k < w.reduction; ++k) {
      const double quotient = scale > 0.0 ? w.at(o, k) / scale : 0.0;
      quotients[index_of(w, o, k)] = quotient;
      pairs[index_of(w, o, k)] = static_cast<std::uint16_t>(std::lround(quotient));
    }
  }
}

template <>
Case random_case<QuantizeWeightsArgs>(RandomValues& random) {
  const int inputs = random.size(200), outputs = random.size(70);
  return make(random, inputs, outputs, random.coin(), random.coin() ? 32767 : 16383);
}

template <>
Case typical_case<QuantizeWeightsArgs>(RandomValues& random) {
  return make(random, 384, 96, false, 16383);
}

}  // namespace mien::conformance
