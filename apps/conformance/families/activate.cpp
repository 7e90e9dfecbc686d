// Cases of activate, with the expected results.
#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::ActivateArgs;

Case make(RandomValues& random, int pixels, int channels, bool in_place,
          const RandomActivation& activation) {
  const std::vector<float> x = random.map(pixels, channels);
  const std::vector<Approx> y = expected_map(channels, pixels, [&](int c, int p) {
    return activation(compared(static_cast<double>(x[blocked(c, p, pixels)])), c);
  });
  Case test;
  test.shape = std::to_string(pixels) + " pixels, " + std::to_string(channels) + " channels, " +
               activation.name() + (in_place ? ", in place" : "");
  if (in_place) {
    test.buffers = {reads(activation.slopes), updates(x, y)};
  } else {
    test.buffers = {reads(activation.slopes), writes(Element::kFloat, y), reads(x)};
  }
  test.bind = [=](const Addresses& buffers) {
    return arguments(ActivateArgs{buffers.floats(in_place ? 1 : 2), buffers.floats(1),
                                  activation.spec(buffers.halves(0)), pixels, channels});
  };
  test.call = call<ActivateArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<ActivateArgs>(RandomValues& random) {
  const int pixels = random.size(50), channels = random.size(33);
  const bool in_place = random.coin();
  const RandomActivation activation(random, channels);
  return make(random, pixels, channels, in_place, activation);
}

template <>
Case typical_case<ActivateArgs>(RandomValues& random) {
  RandomActivation sigmoid(random, 8);
  sigmoid.kind = kernels::Activation::kSigmoid;
  return make(random, 512, 8, false, sigmoid);
}

}  // namespace mien::conformance
