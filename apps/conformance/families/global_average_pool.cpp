#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::GlobalAveragePoolArgs;

Case make(RandomValues& random, int pixels, int channels) {
  const std::vector<float> x = random.map(pixels, channels);
  const auto mean = [&](int c, int) {
    Sum sum;
    for (int p = 0; p < pixels; ++p) {
      sum.add(x[blocked(c, p, pixels)]);
    }
    return sum.total() * exact(1.0 / pixels);
  };
  Case test;
  test.shape = std::to_string(pixels) + " pixels, " + std::to_string(channels) + " channels";
  test.buffers = {reads(x), writes(Element::kFloat, expected_map(channels, 1, mean))};
  test.bind = [=](const Places& places) {
    return arguments(GlobalAveragePoolArgs{places.floats(0), places.floats(1), pixels, channels});
  };
  test.call = call<GlobalAveragePoolArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<GlobalAveragePoolArgs>(RandomValues& random) {
  const int pixels = random.size(90), channels = random.size(33);
  return make(random, pixels, channels);
}

template <>
Case typical_case<GlobalAveragePoolArgs>(RandomValues& random) {
  return make(random, 49, 64);
}

}  // namespace mien::conformance
