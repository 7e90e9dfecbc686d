// The pointwise kernel selects tiles and the storage of weights by the numbers of pixels and
// inputs. Compares every selection that a tier may make with the reference.
#include <gtest/gtest.h>

#include <cmath>

#include "apps/conformance/random_values.h"
#include "kernels/families.h"
#include "kernels/registry.h"

namespace mien::conformance {
namespace {

using namespace kernels;  // NOLINT: the test is about nothing else

constexpr int kOutputs = 40;  // two panels of 16 and one half panel

std::vector<float> run(Kernel<PointwiseArgs> kernel, const std::vector<float>& x,
                       const std::vector<std::uint16_t>& weights,
                       const std::vector<std::uint16_t>& bias, int pixels, int inputs) {
  std::vector<float> y(static_cast<std::size_t>(pixels * kOutputs));
  kernel({x.data(),
          weights.data(),
          bias.data(),
          y.data(),
          {},
          1,
          pixels,
          inputs,
          kOutputs,
          nullptr,
          0,
          0,
          0,
          0});
  return y;
}

std::vector<float> magnitudes(std::vector<float> values) {
  for (float& one : values) {
    one = std::abs(one);
  }
  return values;
}

std::vector<std::uint16_t> magnitudes(std::vector<std::uint16_t> halves) {
  for (std::uint16_t& one : halves) {
    one &= 0x7FFFu;
  }
  return halves;
}

class PointwiseSizes : public testing::TestWithParam<int> {};

void expect_right(const Entry& entry, int pixels, int inputs) {
  const Arithmetic& by = is_half(entry.tier) ? kHalfArithmetic : kSingleArithmetic;
  RandomValues random(static_cast<std::uint64_t>(pixels), 0, by);
  const std::vector<float> x = random.map(pixels, inputs);
  const auto weights = random.panels(kOutputs, inputs);
  const auto bias = random.bias(kOutputs);
  const auto reference = find<PointwiseArgs>(bit(Tier::kRef));
  const auto want = run(reference, x, weights, bias, pixels, inputs);
  const auto sums =
      run(reference, magnitudes(x), magnitudes(weights), magnitudes(bias), pixels, inputs);
  // Each input is rounded once, half of them up, so their sum grows with the root of their number.
  const double factor = (8.0 + std::sqrt(std::min(inputs, by.chunk))) * by.unit;
  const auto got = run(find<PointwiseArgs>(bit(entry.tier)), x, weights, bias, pixels, inputs);
  for (std::size_t i = 0; i < want.size(); ++i) {
    ASSERT_NEAR(got[i], want[i], factor * static_cast<double>(sums[i]) + 1e-8 + inputs * by.flushed)
        << name(entry.tier) << ", " << pixels << " pixels, element " << i;
  }
}

TEST_P(PointwiseSizes, AgreeWithTheReference) {
  for (const Entry& entry : all_kernels()) {
    if (entry.family != PointwiseArgs::kFamily || (detect_cpu() & bit(entry.tier)) == 0) {
      continue;
    }
    for (int pixels = 1; pixels <= 21; ++pixels) {
      ASSERT_NO_FATAL_FAILURE(expect_right(entry, pixels, GetParam()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Inputs, PointwiseSizes, testing::Values(8, 64, 72, 128, 136, 384));

}  // namespace
}  // namespace mien::conformance
