// Bounds cover the errors of fp32, and are not much wider.
#include "apps/conformance/approx.h"

#include <gtest/gtest.h>

#include <random>

namespace mien::tests {
namespace {

using conformance::Approx;
using conformance::kUnit;
using conformance::Sum;

TEST(Approx, ASumsBoundGrowsWithWhatIsAddedNotWithWhatIsLeft) {
  Sum sum;
  sum.add(1e6, 1.0);
  sum.add(-1e6, 1.0);
  EXPECT_EQ(sum.total().value, 0.0);
  EXPECT_GT(sum.total().error, kUnit * 2e6);
  EXPECT_LT(sum.total().error, 16 * kUnit * 2e6);
}

TEST(Approx, SequentialFloatSumsStayWithin) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> values(
      0.0f, 1.0f);  // equal signs, so that partial sums stay large
  for (int round = 0; round < 200; ++round) {
    Sum sum;
    float in_order = 0.0f;
    for (int i = 0; i < 2000; ++i) {
      const float x = values(random), w = values(random);
      sum.add(x, w);
      in_order += x * w;
    }
    const Approx total = sum.total();
    EXPECT_NEAR(static_cast<double>(in_order), total.value, total.error);
  }
}

TEST(Approx, FollowsErrorsThroughASaturatingFunction) {
  const Approx steep = conformance::sigmoid({0.0, 0.1}), flat = conformance::sigmoid({50.0, 0.1});
  EXPECT_NEAR(steep.error, 0.025, 1e-4);
  EXPECT_LT(flat.error, 1e-6);
  const Approx across =
      conformance::activated({5.9, 0.3}, {kernels::Activation::kRelu6, 0.0f, nullptr}, 0.0);
  EXPECT_NEAR(across.error, 0.3, 1e-6);
}

}  // namespace
}  // namespace mien::tests
