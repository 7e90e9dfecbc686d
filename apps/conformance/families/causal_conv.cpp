// Cases of causal_conv, with the expected results.
#include "apps/conformance/families/dense.h"

namespace mien::conformance {
namespace {

using kernels::CausalConvArgs;

std::vector<Approx> exactly(const std::vector<float>& values) {
  std::vector<Approx> same;
  same.reserve(values.size());
  for (const float one : values) {
    same.push_back(exact(static_cast<double>(one)));
  }
  return same;
}

Case make(RandomValues& random, int in_elems, int out_c, const RandomActivation& activation) {
  const std::vector<float> x = random.plain(in_elems), previous = random.plain(in_elems);
  const std::vector<std::uint16_t> weights = random.panels(out_c, 2 * in_elems),
                                   bias = random.bias(out_c);
  std::vector<float> both = previous;
  both.insert(both.end(), x.begin(), x.end());
  const auto at = [&](int o, int) {
    return activation(dense_output(both, weights, bias, out_c, o, random.arithmetic()), o);
  };
  Case test;
  test.shape = std::to_string(in_elems) + " to " + std::to_string(out_c) + ", " + activation.name();
  test.buffers = {reads(x),
                  updates(previous, exactly(x)),
                  reads(weights),
                  reads(bias),
                  reads(activation.slopes),
                  writes(Element::kFloat, expected_map(out_c, 1, at))};
  test.bind = [=](const Addresses& buffers) {
    return arguments(CausalConvArgs{buffers.floats(0), buffers.floats(1), buffers.halves(2),
                                    buffers.halves(3), buffers.floats(5),
                                    activation.spec(buffers.halves(4)), in_elems, out_c});
  };
  test.call = call<CausalConvArgs>;
  test.macs = 2 * static_cast<std::uint64_t>(in_elems) * static_cast<std::uint64_t>(out_c);
  return test;
}

}  // namespace

template <>
Case random_case<CausalConvArgs>(RandomValues& random) {
  const int in_elems = 8 * random.size(25), out_c = random.size(65);
  const RandomActivation activation(random, out_c);
  return make(random, in_elems, out_c, activation);
}

template <>
Case typical_case<CausalConvArgs>(RandomValues& random) {
  return make(random, 256, 128, {});
}

}  // namespace mien::conformance
