#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::GlobalAveragePoolArgs;

// A kernel divides by the count, or multiplies by its rounded reciprocal.
Approx mean(const std::vector<float>& x, int channel, int pixels) {
  Sum sum;
  for (int p = 0; p < pixels; ++p) {
    sum.add(static_cast<double>(x[blocked(channel, p, pixels)]));
  }
  return sum.total() * rounded(exact(1.0 / pixels));
}

Case make(RandomValues& random, int pixels, int channels) {
  const std::vector<float> x = random.map(pixels, channels);
  Case test;
  test.shape = std::to_string(pixels) + " pixels, " + std::to_string(channels) + " channels";
  test.buffers = {reads(x), writes(Element::kFloat, expected_map(channels, 1, [&](int c, int) {
                                     return mean(x, c, pixels);
                                   }))};
  test.bind = [=](const Places& places) {
    return arguments(GlobalAveragePoolArgs{places.floats(0), places.floats(1), pixels, channels});
  };
  test.call = call<GlobalAveragePoolArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<GlobalAveragePoolArgs>(RandomValues& random) {
  const int pixels = random.size(60);
  return make(random, pixels, random.size(33));
}

template <>
Case typical_case<GlobalAveragePoolArgs>(RandomValues& random) {
  return make(random, 7 * 7, 320);
}

}  // namespace mien::conformance
