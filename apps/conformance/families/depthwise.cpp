// Cases of depthwise, with the expected results.
#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::DepthwiseArgs;

Case make(RandomValues& random, const Window& window, int channels,
          const RandomActivation& activation) {
  const int in_pixels = window.in_pixels(), out_pixels = window.out_pixels();
  const int taps = window.kernel_h * window.kernel_w;
  const std::vector<float> x = random.map(in_pixels, channels);
  const std::vector<std::uint16_t> bias = random.bias(channels);
  // [block][tap][8]: like a blocked map, but unused lanes need not be zero.
  const std::vector<std::uint16_t> weights = random.halves(padded(channels) * taps);

  const auto at = [&](int c, int out_pixel) {
    Sum sum(random.arithmetic());
    sum.add(widened(bias[static_cast<std::size_t>(c)]));
    window.for_each(out_pixel, [&](int tap, int pixel) {
      sum.add(x[blocked(c, pixel, in_pixels)], widened(weights[blocked(c, tap, taps)]));
    });
    return activation(sum.total(), c);
  };
  Case test;
  test.shape = window.text() + ", " + std::to_string(channels) + " channels, " + activation.name();
  test.buffers = {reads(x), reads(weights), reads(bias), reads(activation.slopes),
                  writes(Element::kFloat, expected_map(channels, out_pixels, at))};
  test.bind = [=](const Addresses& buffers) {
    DepthwiseArgs args{};
    args.x = buffers.floats(0);
    args.weights = buffers.halves(1);
    args.bias = buffers.halves(2);
    args.y = buffers.floats(4);
    args.activation = activation.spec(buffers.halves(3));
    args.channels = channels;
    set_window(window, args);
    return arguments(args);
  };
  test.call = call<DepthwiseArgs>;
  test.macs = static_cast<std::uint64_t>(out_pixels) * as_size(taps * channels);
  return test;
}

// Mostly 3x3, like all depthwise layers of mien's networks.
Window random_window(RandomValues& random) {
  Window window = Window::random(random, 5, 2);
  while (random.case_number() % 3 != 0 && (window.kernel_h != 3 || window.kernel_w != 3)) {
    window = Window::random(random, 3, 2);
  }
  return window;
}

}  // namespace

template <>
Case random_case<DepthwiseArgs>(RandomValues& random) {
  const Window window = random_window(random);
  const int channels = random.size(49);
  const RandomActivation activation(random, channels);
  return make(random, window, channels, activation);
}

template <>
Case typical_case<DepthwiseArgs>(RandomValues& random) {
  return make(random, {32, 32, 30, 30, 3, 3, 1, 1, 0, 0}, 32, {});
}

}  // namespace mien::conformance
