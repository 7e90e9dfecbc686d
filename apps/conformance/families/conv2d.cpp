// Cases of conv2d, with the expected results.
#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::Conv2dArgs;

Case make(RandomValues& random, const Window& window, int in_c, int out_c, bool interleaved,
          const RandomActivation& activation) {
  const int in_pixels = window.in_pixels(), out_pixels = window.out_pixels();
  const int reduction = window.kernel_h * window.kernel_w * in_c;
  const std::vector<float> x =
      interleaved ? random.plain(in_pixels * in_c) : random.map(in_pixels, in_c);
  const std::vector<std::uint16_t> weights = random.panels(out_c, reduction),
                                   bias = random.bias(out_c);

  const auto at = [&](int o, int out_pixel) {
    Sum sum(random.arithmetic());
    sum.add(widened(bias[static_cast<std::size_t>(o)]));
    window.for_each(out_pixel, [&](int k, int pixel) {
      for (int i = 0; i < in_c; ++i) {
        const std::size_t from =
            interleaved ? as_size(pixel * in_c + i) : blocked(i, pixel, in_pixels);
        sum.add(x[from], panel_weight(weights, out_c, reduction, o, k * in_c + i));
      }
    });
    return activation(sum.total(), o);
  };
  Case test;
  test.shape = window.text() + ", channels " + std::to_string(in_c) + " to " +
               std::to_string(out_c) + ", " + (interleaved ? "interleaved, " : "") +
               activation.name();
  test.buffers = {reads(x), reads(weights), reads(bias), reads(activation.slopes),
                  writes(Element::kFloat, expected_map(out_c, out_pixels, at))};
  test.bind = [=](const Addresses& buffers) {
    Conv2dArgs args{};
    args.x = buffers.floats(0);
    args.weights = buffers.halves(1);
    args.bias = buffers.halves(2);
    args.y = buffers.floats(4);
    args.activation = activation.spec(buffers.halves(3));
    set_window(window, args);
    args.in_c = in_c;
    args.x_pixel_elems = interleaved ? in_c : 8;
    args.out_c = out_c;
    return arguments(args);
  };
  test.call = call<Conv2dArgs>;
  test.macs = static_cast<std::uint64_t>(out_pixels) * as_size(reduction * out_c);
  return test;
}

}  // namespace

template <>
Case random_case<Conv2dArgs>(RandomValues& random) {
  const Window window = Window::random(random, 5, 3);
  const bool interleaved = random.coin();
  const int in_c = interleaved ? random.between(1, 4) : random.size(25);
  const int out_c = random.size(49);
  const RandomActivation activation(random, out_c);
  return make(random, window, in_c, out_c, interleaved, activation);
}

template <>
Case typical_case<Conv2dArgs>(RandomValues& random) {
  return make(random, {65, 65, 32, 32, 3, 3, 2, 2, 0, 0}, 3, 16, true, {});
}

}  // namespace mien::conformance
