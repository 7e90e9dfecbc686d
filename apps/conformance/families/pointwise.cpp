// Cases of pointwise, with the expected results.
#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::PointwiseArgs;

struct Size {
  int h, w, in_c, out_c;
};

Case make(RandomValues& random, const Size& size, const RandomActivation& activation,
          const ResidualSlice* slice) {
  const int h = size.h, w = size.w, in_c = size.in_c, out_c = size.out_c;
  const int pixels = h * w, reduction = padded(in_c);
  const std::vector<float> x = random.map(pixels, in_c);
  const std::vector<std::uint16_t> weights = random.panels(out_c, reduction),
                                   bias = random.bias(out_c);
  const std::vector<float> residual =
      slice != nullptr ? random.map(slice->pixels(), out_c) : std::vector<float>();

  const auto at = [&](int o, int p) {
    Sum sum(random.arithmetic());
    sum.add(widened(bias[static_cast<std::size_t>(o)]));
    for (int i = 0; i < in_c; ++i) {
      sum.add(x[blocked(i, p, pixels)], panel_weight(weights, out_c, reduction, o, i));
    }
    const Approx y = activation(sum.total(), o);
    return slice == nullptr ? y
                            : y + exact(residual[blocked(o, slice->pixel(p, w), slice->pixels())]);
  };
  Case test;
  test.shape = times(h, w) + "x" + std::to_string(in_c) + " to " + std::to_string(out_c) + ", " +
               activation.name() + (slice != nullptr ? ", residual" : "");
  test.buffers = {reads(x),        reads(weights),
                  reads(bias),     reads(activation.slopes),
                  reads(residual), writes(Element::kFloat, expected_map(out_c, pixels, at))};
  const ResidualSlice taken = slice != nullptr ? *slice : ResidualSlice();
  test.bind = [=](const Addresses& buffers) {
    PointwiseArgs args{};
    args.x = buffers.floats(0);
    args.weights = buffers.halves(1);
    args.bias = buffers.halves(2);
    args.y = buffers.floats(5);
    args.activation = activation.spec(buffers.halves(3));
    args.h = h;
    args.w = w;
    args.in_c = in_c;
    args.out_c = out_c;
    if (taken.h > 0) {
      set_residual(taken, buffers.floats(4), args);
    }
    return arguments(args);
  };
  test.call = call<PointwiseArgs>;
  test.macs = static_cast<std::uint64_t>(pixels) * as_size(in_c * out_c);
  return test;
}

}  // namespace

template <>
Case random_case<PointwiseArgs>(RandomValues& random) {
  const Size size{random.between(1, 9), random.size(26), random.size(49), random.size(65)};
  const RandomActivation activation(random, size.out_c);
  const ResidualSlice slice = ResidualSlice::random(random, size.h, size.w);
  return make(random, size, activation, random.coin() ? &slice : nullptr);
}

template <>
Case typical_case<PointwiseArgs>(RandomValues& random) {
  return make(random, {13, 13, 32, 48}, {}, nullptr);
}

}  // namespace mien::conformance
