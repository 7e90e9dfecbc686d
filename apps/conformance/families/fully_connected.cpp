// Cases of fully_connected, with the expected results.
#include "apps/conformance/families/dense.h"

namespace mien::conformance {
namespace {

using kernels::FullyConnectedArgs;

Case make(RandomValues& random, int in_elems, int out_c, const RandomActivation& activation) {
  const std::vector<float> x = random.plain(in_elems);
  const std::vector<std::uint16_t> weights = random.panels(out_c, in_elems),
                                   bias = random.bias(out_c);
  const auto at = [&](int o, int) {
    return activation(dense_output(x, weights, bias, out_c, o, random.arithmetic()), o);
  };
  Case test;
  test.shape = std::to_string(in_elems) + " to " + std::to_string(out_c) + ", " + activation.name();
  test.buffers = {reads(x), reads(weights), reads(bias), reads(activation.slopes),
                  writes(Element::kFloat, expected_map(out_c, 1, at))};
  test.bind = [=](const Addresses& buffers) {
    return arguments(FullyConnectedArgs{buffers.floats(0), buffers.halves(1), buffers.halves(2),
                                        buffers.floats(4), activation.spec(buffers.halves(3)),
                                        in_elems, out_c});
  };
  test.call = call<FullyConnectedArgs>;
  test.macs = static_cast<std::uint64_t>(in_elems) * static_cast<std::uint64_t>(out_c);
  return test;
}

}  // namespace

template <>
Case random_case<FullyConnectedArgs>(RandomValues& random) {
  const int in_elems = 8 * random.size(40), out_c = random.size(97);
  const RandomActivation activation(random, out_c);
  return make(random, in_elems, out_c, activation);
}

template <>
Case typical_case<FullyConnectedArgs>(RandomValues& random) {
  return make(random, 256, 350, {});
}

}  // namespace mien::conformance
