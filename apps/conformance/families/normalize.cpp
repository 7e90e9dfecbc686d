// Cases of normalize, with the expected results.
#include <algorithm>

#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::NormalizeArgs;

// One pixel. The error of its mean enters every difference, and its square the variance.
std::vector<Approx> normalized(const std::vector<double>& x, double epsilon) {
  const auto count = static_cast<double>(x.size());
  Sum sum;
  for (const double one : x) {
    sum.add(one, 1.0 / count);
  }
  const Approx mean = sum.total();
  double variance = 0.0, error = kFlushed;
  for (const double one : x) {
    const double difference = one - mean.value;
    const double own = mean.error + kUnit * std::abs(difference);
    variance += difference * difference / count;
    error += own * (2 * std::abs(difference) + own) / count;
  }
  error += sum_factor(static_cast<int>(x.size())) * kUnit * variance;
  const double scale = 1.0 / std::sqrt(variance + epsilon);
  const double largest_scale = 1.0 / std::sqrt(std::max(variance - error, 0.0) + epsilon);
  const double smallest_scale = 1.0 / std::sqrt(variance + error + epsilon);
  const double scale_error =
      std::max(largest_scale - scale, scale - smallest_scale) + kSumFactor * kUnit * scale;
  std::vector<Approx> y;
  for (const double one : x) {
    const double difference = one - mean.value;
    const double own = mean.error + kUnit * std::abs(difference) + kFlushed;
    y.push_back(rounded(
        {difference * scale, std::abs(difference) * scale_error + own * (scale + scale_error)}));
  }
  return y;
}

Case make(RandomValues& random, int pixels, int channels, float epsilon, bool in_place) {
  std::vector<float> x = random.map(pixels, channels);
  for (float& one : x) {  // squares must not overflow
    one = std::clamp(one, -1e15f, 1e15f);
  }
  std::vector<Approx> y(x.size());
  for (int p = 0; p < pixels; ++p) {
    std::vector<double> pixel;
    pixel.reserve(as_size(channels));
    for (int c = 0; c < channels; ++c) {
      pixel.push_back(static_cast<double>(x[blocked(c, p, pixels)]));
    }
    const std::vector<Approx> expected = normalized(pixel, static_cast<double>(epsilon));
    for (int c = 0; c < channels; ++c) {
      y[blocked(c, p, pixels)] = expected[as_size(c)];
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
    return arguments(NormalizeArgs{buffers.floats(in_place ? 0 : 1), buffers.floats(0), epsilon,
                                   pixels, channels});
  };
  test.call = call<NormalizeArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<NormalizeArgs>(RandomValues& random) {
  const int pixels = random.size(25), channels = random.size(33);
  return make(random, pixels, channels, random.coin() ? 1e-6f : 1e-3f, random.coin());
}

template <>
Case typical_case<NormalizeArgs>(RandomValues& random) {
  return make(random, 196, 96, 1e-6f, false);
}

}  // namespace mien::conformance
