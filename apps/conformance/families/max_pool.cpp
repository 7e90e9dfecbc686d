// Cases of max_pool, with the expected results.
#include <algorithm>
#include <limits>

#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::MaxPoolArgs;

Case make(RandomValues& random, const Window& window, int channels) {
  const int in_pixels = window.in_pixels(), out_pixels = window.out_pixels();
  const std::vector<float> x = random.map(in_pixels, channels);
  const auto at = [&](int c, int out_pixel) {
    double largest = -std::numeric_limits<double>::infinity();
    window.for_each(out_pixel, [&](int, int pixel) {
      largest = std::max(largest, static_cast<double>(x[blocked(c, pixel, in_pixels)]));
    });
    return compared(largest);
  };
  Case test;
  test.shape = window.text() + ", " + std::to_string(channels) + " channels";
  test.buffers = {reads(x), writes(Element::kFloat, expected_map(channels, out_pixels, at))};
  test.bind = [=](const Addresses& buffers) {
    MaxPoolArgs args{};
    args.x = buffers.floats(0);
    args.y = buffers.floats(1);
    args.channels = channels;
    set_window(window, args);
    return arguments(args);
  };
  test.call = call<MaxPoolArgs>;
  return test;
}

// Every window must contain a value, also the last one, which may be clipped.
Window random_window(RandomValues& random) {
  Window window{};
  window.kernel_h = random.between(1, 3);
  window.kernel_w = random.between(1, 3);
  window.stride_h = random.between(1, 3);
  window.stride_w = random.between(1, 3);
  window.pad_top = random.between(0, window.kernel_h - 1);
  window.pad_left = random.between(0, window.kernel_w - 1);
  window.in_h = random.size(12) + window.kernel_h;
  window.in_w = random.size(25) + window.kernel_w;
  window.out_h = (window.in_h + window.pad_top - 1) / window.stride_h + 1;
  window.out_w = (window.in_w + window.pad_left - 1) / window.stride_w + 1;
  return window;
}

}  // namespace

template <>
Case random_case<MaxPoolArgs>(RandomValues& random) {
  const Window window = random_window(random);
  return make(random, window, random.size(33));
}

template <>
Case typical_case<MaxPoolArgs>(RandomValues& random) {
  return make(random, {22, 22, 11, 11, 3, 3, 2, 2, 0, 0}, 32);
}

}  // namespace mien::conformance
