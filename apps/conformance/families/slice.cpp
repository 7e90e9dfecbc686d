#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::SliceArgs;

Case make(RandomValues& random, SliceArgs args, int in_channels) {
  const std::vector<float> x = random.map(args.in_h * args.in_w, in_channels);
  const auto at = [&](int c, int p) {
    const int pixel = (args.top + p / args.w) * args.in_w + args.left + p % args.w;
    return exact(
        static_cast<double>(x[blocked(args.first_channel + c, pixel, args.in_h * args.in_w)]));
  };
  Case test;
  test.shape = times(args.h, args.w) + "x" + std::to_string(args.channels) + " of " +
               times(args.in_h, args.in_w) + ", from channel " + std::to_string(args.first_channel);
  test.buffers = {reads(x),
                  writes(Element::kFloat, expected_map(args.channels, args.h * args.w, at))};
  test.bind = [args](const Places& places) {
    SliceArgs bound = args;
    bound.x = places.floats(0);
    bound.y = places.floats(1);
    return arguments(bound);
  };
  test.call = call<SliceArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<SliceArgs>(RandomValues& random) {
  SliceArgs args{};
  args.h = random.size(9);
  args.w = random.size(25);
  args.channels = random.size(33);
  args.top = random.between(0, 2);
  args.left = random.between(0, 2);
  args.first_channel = random.between(0, 20);
  args.in_h = args.h + args.top + random.between(0, 2);
  args.in_w = args.w + args.left + random.between(0, 2);
  return make(random, args, args.first_channel + args.channels + random.between(0, 9));
}

template <>
Case typical_case<SliceArgs>(RandomValues& random) {
  SliceArgs args{};
  args.in_h = args.in_w = 16;
  args.h = args.w = 14;
  args.top = args.left = 1;
  args.channels = 24;
  return make(random, args, 24);
}

}  // namespace mien::conformance
