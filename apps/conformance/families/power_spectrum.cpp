// Cases of power_spectrum, with the expected results.
#include <cmath>
#include <complex>
#include <numbers>

#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::PowerSpectrumArgs;

std::vector<float> twiddles(int n) {
  std::vector<float> values;
  for (int j = 0; j < n; ++j) {
    const double turn = 2.0 * std::numbers::pi * j / n;
    values.push_back(static_cast<float>(std::cos(turn)));
    values.push_back(static_cast<float>(-std::sin(turn)));
  }
  return values;
}

// Limits magnitudes so that squares do not overflow fp32.
std::vector<float> signal(RandomValues& random, int n) {
  std::vector<float> values = random.plain(n);
  for (float& one : values) {
    one = std::abs(one) > 1e12f ? one * 1e-14f : one;
  }
  return values;
}

// The definition in double precision. A fast transform in fp32 has log2 n stages that
// round, and rounded factors; all errors are relative to sum|x|.
Approx power(const std::vector<float>& x, int k) {
  const int n = static_cast<int>(x.size());
  std::complex<double> sum;
  double magnitude = 0.0;
  for (int j = 0; j < n; ++j) {
    const double turn = -2.0 * std::numbers::pi * (j * k % n) / n;
    const auto value = static_cast<double>(x[static_cast<std::size_t>(j)]);
    sum += value * std::complex<double>(std::cos(turn), std::sin(turn));
    magnitude += std::abs(value);
  }
  const double error = kSumFactor * kUnit * magnitude + n * kFlushed;
  return rounded(
      {std::norm(sum), 2 * std::abs(sum) * error + error * error + 2 * kUnit * std::norm(sum)});
}

Case make(RandomValues& random, int n) {
  const std::vector<float> x = signal(random, n);
  std::vector<Approx> y;
  for (int k = 0; k <= n / 2; ++k) {
    y.push_back(power(x, k));
  }
  Case test;
  test.shape = std::to_string(n) + " samples";
  test.buffers = {reads(x), reads(twiddles(n)), writes(Element::kFloat, y)};
  test.bind = [=](const Addresses& buffers) {
    return arguments(PowerSpectrumArgs{buffers.floats(0), buffers.floats(1), buffers.floats(2), n});
  };
  test.call = call<PowerSpectrumArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<PowerSpectrumArgs>(RandomValues& random) {
  return make(random, PowerSpectrumArgs::kMinSize << random.between(0, 3));
}

template <>
Case typical_case<PowerSpectrumArgs>(RandomValues& random) {
  return make(random, 256);
}

}  // namespace mien::conformance
