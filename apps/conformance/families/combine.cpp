// Cases of combine, with the expected results.
#include <algorithm>

#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::Combination;
using kernels::CombineArgs;

struct Repeats {
  bool rows, columns, channels;
};

// Scales b so that the product or quotient does not overflow fp32.
float limited(float b, Combination kind) {
  constexpr float kMax = 1e8f;
  const float limited = std::clamp(b, -kMax, kMax);
  const bool divides = kind == Combination::kQuotient;
  return divides ? (limited < 0 ? limited - 0.5f : limited + 0.5f) : limited;
}

// ARMv7 divides with an estimate that Newton's method refines to a few units.
Approx quotient(double a, double b) {
  constexpr double kUnits = 4.0;
  const double flushed = std::abs(a) < kFlushed ? kFlushed / std::abs(b) : 0.0;
  return rounded({a / b, flushed + kUnits * kUnit * std::abs(a / b)});
}

Approx combined(Combination kind, double a, double b) {
  switch (kind) {
    case Combination::kProduct:
      return compared(a) * compared(b);
    case Combination::kQuotient:
      return quotient(a, b);
    case Combination::kSum:
      break;
  }
  return compared(a) + compared(b);
}

Case make(RandomValues& random, int h, int w, int channels, Combination kind, Repeats repeats,
          bool in_place) {
  const int pixels = h * w;
  const int b_h = repeats.rows ? 1 : h, b_w = repeats.columns ? 1 : w;
  const int b_channels = repeats.channels ? 1 : channels;
  const std::vector<float> a = random.map(pixels, channels);
  std::vector<float> b = random.map(b_h * b_w, b_channels);
  std::transform(b.begin(), b.end(), b.begin(), [&](float x) { return limited(x, kind); });
  const std::vector<Approx> y = expected_map(channels, pixels, [&](int c, int p) {
    const int b_pixel = (repeats.rows ? 0 : p / w) * b_w + (repeats.columns ? 0 : p % w);
    const float other = b[blocked(repeats.channels ? 0 : c, b_pixel, b_h * b_w)];
    return combined(kind, static_cast<double>(a[blocked(c, p, pixels)]),
                    static_cast<double>(other));
  });
  Case test;
  test.shape = times(h, w) + "x" + std::to_string(channels) + " with " + times(b_h, b_w) + "x" +
               std::to_string(b_channels) + ", kind " + std::to_string(static_cast<int>(kind)) +
               (in_place ? ", in place" : "");
  if (in_place) {
    test.buffers = {reads(b), updates(a, y)};
  } else {
    test.buffers = {reads(b), writes(Element::kFloat, y), reads(a)};
  }
  test.bind = [=](const Addresses& buffers) {
    return arguments(CombineArgs{buffers.floats(in_place ? 1 : 2), buffers.floats(0),
                                 buffers.floats(1), kind, h, w, channels, repeats.rows,
                                 repeats.columns, repeats.channels});
  };
  test.call = call<CombineArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<CombineArgs>(RandomValues& random) {
  const int h = random.between(1, 9), w = random.size(26), channels = random.size(33);
  const auto kind = static_cast<Combination>(random.between(0, 2));
  const Repeats repeats{random.coin(), random.coin(), random.coin()};
  return make(random, h, w, channels, kind, repeats, random.coin());
}

template <>
Case typical_case<CombineArgs>(RandomValues& random) {
  return make(random, 14, 14, 96, Combination::kProduct, {true, true, false}, false);
}

}  // namespace mien::conformance
