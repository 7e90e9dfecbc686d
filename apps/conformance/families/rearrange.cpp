// Cases of rearrange, with the expected results.
#include <algorithm>

#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::Axis;
using kernels::RearrangeArgs;

struct Size {
  int h, w, c;
  [[nodiscard]] int pixels() const { return h * w; }
};

Case make(RandomValues& random, Size in, Size out, const Axis (&order)[3]) {
  const std::vector<float> x = random.map(in.pixels(), in.c);
  const int sizes[3] = {in.h, in.w, in.c};
  const auto axis = [&](int i) { return static_cast<int>(order[i]); };
  std::vector<Approx> y(as_size(padded(out.c) * out.pixels()));
  int element = 0, at[3] = {};
  for (int i = 0; i < sizes[axis(0)]; ++i) {
    for (int j = 0; j < sizes[axis(1)]; ++j) {
      for (int k = 0; k < sizes[axis(2)]; ++k, ++element) {
        at[axis(0)] = i;
        at[axis(1)] = j;
        at[axis(2)] = k;
        const float value = x[blocked(at[2], at[0] * in.w + at[1], in.pixels())];
        y[blocked(element % out.c, element / out.c, out.pixels())] =
            exact(static_cast<double>(value));
      }
    }
  }
  RearrangeArgs shared{};
  shared.in_h = in.h;
  shared.in_w = in.w;
  shared.in_c = in.c;
  shared.out_h = out.h;
  shared.out_w = out.w;
  shared.out_c = out.c;
  std::copy(std::begin(order), std::end(order), std::begin(shared.order));
  Case test;
  test.shape = times(in.h, in.w) + "x" + std::to_string(in.c) + " as " + times(out.h, out.w) + "x" +
               std::to_string(out.c) + ", order " + std::to_string(axis(0)) +
               std::to_string(axis(1)) + std::to_string(axis(2));
  test.buffers = {reads(x), writes(Element::kFloat, y)};
  test.bind = [=](const Addresses& buffers) {
    RearrangeArgs args = shared;
    args.x = buffers.floats(0);
    args.y = buffers.floats(1);
    return arguments(args);
  };
  test.call = call<RearrangeArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<RearrangeArgs>(RandomValues& random) {
  // Both shapes are products of the same factors.
  const int factors[] = {random.between(1, 5), random.between(1, 5), random.between(1, 5),
                         random.size(9)};
  int in[3] = {1, 1, 1}, out[3] = {1, 1, 1};
  for (const int factor : factors) {
    in[random.between(0, 2)] *= factor;
    out[random.between(0, 2)] *= factor;
  }
  Axis order[3] = {Axis::kRow, Axis::kColumn, Axis::kChannel};
  std::swap(order[0], order[random.between(0, 2)]);
  std::swap(order[1], order[random.between(1, 2)]);
  return make(random, {in[0], in[1], in[2]}, {out[0], out[1], out[2]}, order);
}

template <>
Case typical_case<RearrangeArgs>(RandomValues& random) {
  return make(random, {30, 40, 12}, {1, 1, 14400}, {Axis::kRow, Axis::kColumn, Axis::kChannel});
}

}  // namespace mien::conformance
