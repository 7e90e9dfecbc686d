// Cases of residual_add, with the expected results.
#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::ResidualAddArgs;

Case make(RandomValues& random, int h, int w, int channels, const ResidualSlice& slice,
          bool in_place) {
  const int pixels = h * w;
  const std::vector<float> x = random.map(pixels, channels),
                           residual = random.map(slice.pixels(), channels);
  const std::vector<Approx> y = expected_map(channels, pixels, [&](int c, int p) {
    const float other = residual[blocked(c, slice.pixel(p, w), slice.pixels())];
    return exact(static_cast<double>(x[blocked(c, p, pixels)])) + exact(static_cast<double>(other));
  });
  Case test;
  test.shape = times(h, w) + "x" + std::to_string(channels) + " of " + times(slice.h, slice.w) +
               (in_place ? ", in place" : "");
  if (in_place) {
    test.buffers = {reads(residual), updates(x, y)};
  } else {
    test.buffers = {reads(residual), writes(Element::kFloat, y), reads(x)};
  }
  test.bind = [=](const Addresses& buffers) {
    ResidualAddArgs args{};
    args.x = buffers.floats(in_place ? 1 : 2);
    args.y = buffers.floats(1);
    args.channels = channels;
    args.h = h;
    args.w = w;
    set_residual(slice, buffers.floats(0), args);
    return arguments(args);
  };
  test.call = call<ResidualAddArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<ResidualAddArgs>(RandomValues& random) {
  const int h = random.between(1, 9), w = random.size(26), channels = random.size(33);
  const ResidualSlice slice = ResidualSlice::random(random, h, w);
  return make(random, h, w, channels, slice, random.coin());
}

template <>
Case typical_case<ResidualAddArgs>(RandomValues& random) {
  return make(random, 13, 13, 16, {15, 15, 1, 1}, false);
}

}  // namespace mien::conformance
