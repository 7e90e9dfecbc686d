// Cases of softmax, with the expected results.
#include <algorithm>

#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::SoftmaxArgs;

// The difference is rounded before the exponential, which has an error of 2 ulp and may be clamped
// at -87. If the exact value is far smaller, only the flush error remains.
Approx exponential(double x, double largest) {
  constexpr double kOwnUnits = 8.0;
  const double y = std::exp(x - largest);
  const double units = kOwnUnits + std::min(largest - x, 1e6);
  return {y, kUnit * units * y + 2 * kFlushed};
}

// The softmax of one pixel.
std::vector<Approx> softmax_of(const std::vector<double>& x) {
  const double largest = *std::max_element(x.begin(), x.end());
  Approx sum;
  for (const double one : x) {
    const Approx power = exponential(one, largest);
    sum = {sum.value + power.value, sum.error + power.error};
  }
  sum.error += kSumFactor * kUnit * sum.value;
  std::vector<Approx> y;
  for (const double one : x) {
    const Approx power = exponential(one, largest);
    const double quotient = power.value / sum.value;
    y.push_back(rounded({quotient, (power.error + quotient * sum.error) / sum.value}));
  }
  return y;
}

Case make(RandomValues& random, int pixels, int channels, bool in_place) {
  const std::vector<float> x = random.map(pixels, channels);
  std::vector<Approx> y(x.size());
  for (int p = 0; p < pixels; ++p) {
    std::vector<double> pixel;
    pixel.reserve(static_cast<std::size_t>(channels));
    for (int c = 0; c < channels; ++c) {
      pixel.push_back(static_cast<double>(x[blocked(c, p, pixels)]));
    }
    const std::vector<Approx> parts = softmax_of(pixel);
    for (int c = 0; c < channels; ++c) {
      y[blocked(c, p, pixels)] = parts[static_cast<std::size_t>(c)];
    }
  }
  Case test;
  test.shape = std::to_string(pixels) + " pixels, " + std::to_string(channels) + " channels" +
               (in_place ? ", in place" : "");
  if (in_place) {
    test.buffers = {updates(x, y)};
  } else {
    test.buffers = {writes(Element::kFloat, y), reads(x)};
  }
  test.bind = [=](const Addresses& buffers) {
    return arguments(
        SoftmaxArgs{buffers.floats(in_place ? 0 : 1), buffers.floats(0), pixels, channels});
  };
  test.call = call<SoftmaxArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<SoftmaxArgs>(RandomValues& random) {
  const int pixels = random.size(25), channels = random.size(33);
  return make(random, pixels, channels, random.coin());
}

template <>
Case typical_case<SoftmaxArgs>(RandomValues& random) {
  return make(random, 256, 2, false);
}

}  // namespace mien::conformance
