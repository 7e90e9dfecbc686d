// Cases of slice, with the expected results.
#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::SliceArgs;

Case make(RandomValues& random, int h, int w, int channels, const ResidualSlice& slice,
          int first_channel, int in_channels) {
  const int pixels = h * w;
  const std::vector<float> x = random.map(slice.pixels(), in_channels);
  const auto at = [&](int c, int p) {
    return exact(
        static_cast<double>(x[blocked(first_channel + c, slice.pixel(p, w), slice.pixels())]));
  };
  Case test;
  test.shape = times(h, w) + "x" + std::to_string(channels) + " of " + times(slice.h, slice.w) +
               "x" + std::to_string(in_channels) + " from channel " + std::to_string(first_channel);
  test.buffers = {reads(x), writes(Element::kFloat, expected_map(channels, pixels, at))};
  test.bind = [=](const Addresses& buffers) {
    return arguments(SliceArgs{buffers.floats(0), buffers.floats(1), slice.h, slice.w, slice.top,
                               slice.left, first_channel, h, w, channels});
  };
  test.call = call<SliceArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<SliceArgs>(RandomValues& random) {
  const int h = random.between(1, 6), w = random.size(17), channels = random.size(25);
  const ResidualSlice slice = ResidualSlice::random(random, h, w);
  const int first_channel = random.between(0, 20);
  return make(random, h, w, channels, slice, first_channel,
              first_channel + channels + random.between(0, 9));
}

template <>
Case typical_case<SliceArgs>(RandomValues& random) {
  return make(random, 13, 13, 16, {15, 15, 1, 1}, 4, 32);
}

}  // namespace mien::conformance
