// Tests of the random values of cases.
#include "apps/conformance/random_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace mien::tests {
namespace {

using conformance::Pattern;
using conformance::RandomValues;

TEST(RandomValues, AreTheSameForTheSameSeed) {
  EXPECT_EQ(RandomValues(7, 3).plain(100), RandomValues(7, 3).plain(100));
  EXPECT_NE(RandomValues(7, 3).plain(100), RandomValues(8, 3).plain(100));
}

TEST(RandomValues, EveryPatternHasItsTurn) {
  std::set<Pattern> seen;
  for (int number = 0; number < conformance::kPatternCount; ++number) {
    seen.insert(RandomValues(1, number).pattern());
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(conformance::kPatternCount));
}

TEST(RandomValues, PatternsAreWhatTheySay) {
  const auto magnitudes = [](Pattern pattern) {
    std::vector<float> values = RandomValues(1, pattern).plain(1000);
    for (float& one : values) {
      one = std::abs(one);
    }
    return values;
  };
  const auto below = [](float limit) { return [=](float one) { return one < limit; }; };
  const std::vector<float> denormal = magnitudes(Pattern::kDenormal);
  EXPECT_TRUE(std::all_of(denormal.begin(), denormal.end(), below(1.18e-38f)));
  const std::vector<float> huge = magnitudes(Pattern::kHuge);
  EXPECT_GT(*std::max_element(huge.begin(), huge.end()), 5e28f);
  EXPECT_TRUE(std::all_of(huge.begin(), huge.end(), below(1.01e29f)));
  const std::vector<float> sparse = magnitudes(Pattern::kSparse);
  EXPECT_GT(std::count(sparse.begin(), sparse.end(), 0.0f), 700);
  const std::vector<float> cancelling = RandomValues(1, Pattern::kCancelling).plain(1000);
  double sum = 0.0, magnitude = 0.0;
  for (const float one : cancelling) {
    sum += static_cast<double>(one);
    magnitude += std::abs(static_cast<double>(one));
  }
  EXPECT_LT(std::abs(sum), 0.1 * magnitude);
}

TEST(RandomValues, SizesLieAroundTiles) {
  RandomValues random(1);
  std::set<int> sizes;
  for (int i = 0; i < 3000; ++i) {
    const int size = random.size(65);
    ASSERT_GE(size, 1);
    ASSERT_LE(size, 65);
    sizes.insert(size);
  }
  for (const int wanted : {1, 2, 7, 8, 9, 15, 16, 17, 31, 32, 33, 47, 48, 49, 53, 63, 64, 65}) {
    EXPECT_TRUE(sizes.contains(wanted)) << wanted;
  }
}

}  // namespace
}  // namespace mien::tests
