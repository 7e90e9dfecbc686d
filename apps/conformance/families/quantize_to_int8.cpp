// Cases of quantize_to_int8, with the expected results.
#include <cmath>
#include <numeric>

#include "apps/conformance/families/quantized_weights.h"

namespace mien::conformance {
namespace {

using kernels::QuantizeToInt8Args;

int padded_to_16(int inputs) { return (inputs + 15) / 16 * 16; }

std::size_t index_of(int panel, int outputs, int reduction, int o, int k) {
  return index_in_panels(panel, outputs, reduction, 4, o, k);
}

double largest_weight(const std::vector<std::uint16_t>& panels, int outputs, int inputs, int o) {
  double largest = 0.0;
  for (int k = 0; k < inputs; ++k) {
    largest = std::max(largest, std::abs(panel_weight(panels, outputs, inputs, o, k)));
  }
  return largest;
}

// fp32 scales differ from those in double precision, which decides ties.
std::vector<Approx> expected_quads(const std::vector<double>& quotients) {
  std::vector<Approx> all;
  all.reserve(quotients.size());
  for (const double one : quotients) {
    all.push_back({one, one == 0.0 ? 0.0 : 0.5 + std::abs(one) * 0x1p-20});
  }
  return all;
}

std::vector<Approx> expected_scales(const std::vector<float>& scales) {
  std::vector<Approx> all;
  all.reserve(scales.size());
  for (const float scale : scales) {
    all.push_back({static_cast<double>(scale), static_cast<double>(scale) * 4.0 * kUnit});
  }
  return all;
}

// A kernel may decide every tie between two integers in another way.
std::vector<Approx> expected_sums(const Int8Weights& weights, int reduction) {
  std::vector<Approx> all;
  const int outputs = static_cast<int>(weights.sums.size());
  for (int o = 0; o < outputs; ++o) {
    int ties = 0;
    for (int k = 0; k < reduction; ++k) {
      const double one =
          std::abs(weights.quotients[index_of(weights.panel, outputs, reduction, o, k)]);
      ties += std::abs(one - std::floor(one) - 0.5) <= one * 0x1p-20 ? 1 : 0;
    }
    all.push_back({static_cast<double>(weights.sums[as_size(o)]), static_cast<double>(ties)});
  }
  return all;
}

Case make(RandomValues& random, int inputs, int outputs) {
  const std::vector<std::uint16_t> panels = random.panels(outputs, padded(inputs));
  const int panel = random.arithmetic().int8_panel;
  const Int8Weights weights(panels, outputs, inputs, panel);
  Case test;
  test.shape = std::to_string(inputs) + " to " + std::to_string(outputs);
  test.buffers = {reads(panels), writes(Element::kInt8, expected_quads(weights.quotients)),
                  writes(Element::kFloat, expected_scales(weights.scales)),
                  writes(Element::kFloat, expected_sums(weights, padded_to_16(inputs)))};
  test.bind = [=](const Addresses& buffers) {
    return arguments(QuantizeToInt8Args{buffers.halves(0), buffers.int8s(1), buffers.floats(2),
                                        buffers.floats(3), padded(inputs) / 8, padded(outputs) / 8,
                                        panel});
  };
  test.call = call<QuantizeToInt8Args>;
  return test;
}

}  // namespace

Int8Weights::Int8Weights(const std::vector<std::uint16_t>& panels, int outputs, int inputs,
                         int to_panel)
    : quotients(as_size(padded(outputs) * padded_to_16(inputs))),
      quads(quotients.size()),
      panel(to_panel) {
  const int all = padded(outputs), given = padded(inputs), reduction = padded_to_16(inputs);
  for (int o = 0; o < all; ++o) {
    const double scale = largest_weight(panels, all, given, o) / 127.0;
    double sum = 0.0;
    for (int k = 0; k < given && scale > 0.0; ++k) {
      const double quotient = panel_weight(panels, all, given, o, k) / scale;
      const double q = std::nearbyint(quotient);
      const std::size_t at = index_of(panel, all, reduction, o, k);
      quotients[at] = quotient;
      quads[at] = static_cast<std::uint8_t>(static_cast<int>(q));
      sum += q;
    }
    scales.push_back(static_cast<float>(scale));
    sums.push_back(static_cast<float>(sum));
  }
}

template <>
Case random_case<QuantizeToInt8Args>(RandomValues& random) {
  const int inputs = random.size(200), outputs = random.size(70);
  return make(random, inputs, outputs);
}

template <>
Case typical_case<QuantizeToInt8Args>(RandomValues& random) {
  return make(random, 384, 96);
}

}  // namespace mien::conformance
