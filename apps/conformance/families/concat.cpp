// Cases of concat, with the expected results.
#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::ConcatArgs;

Case make(RandomValues& random, int pixels, int a_channels, int b_channels) {
  const std::vector<float> a = random.map(pixels, a_channels), b = random.map(pixels, b_channels);
  const auto at = [&](int c, int p) {
    const float one =
        c < a_channels ? a[blocked(c, p, pixels)] : b[blocked(c - a_channels, p, pixels)];
    return exact(static_cast<double>(one));
  };
  Case test;
  test.shape = std::to_string(pixels) + " pixels, " + std::to_string(a_channels) + " and " +
               std::to_string(b_channels) + " channels";
  test.buffers = {reads(a), reads(b),
                  writes(Element::kFloat, expected_map(a_channels + b_channels, pixels, at))};
  test.bind = [=](const Addresses& buffers) {
    return arguments(ConcatArgs{buffers.floats(0), buffers.floats(1), buffers.floats(2), pixels,
                                a_channels, b_channels});
  };
  test.call = call<ConcatArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<ConcatArgs>(RandomValues& random) {
  const int pixels = random.size(25), a_channels = random.size(34), b_channels = random.size(34);
  return make(random, pixels, a_channels, b_channels);
}

template <>
Case typical_case<ConcatArgs>(RandomValues& random) {
  return make(random, 169, 20, 20);
}

}  // namespace mien::conformance
