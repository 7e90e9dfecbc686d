// Tests of time steps and discontinuities.
#include "tracker/timeline.h"

#include <gtest/gtest.h>

#include <limits>

namespace mien::tracker {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();

Timeline::Step step(std::int64_t from, std::int64_t to) {
  Timeline timeline;
  (void)timeline.advance(from);
  return timeline.advance(to);
}

TEST(Timeline, MeasuresSteps) {
  EXPECT_FLOAT_EQ(step(0, 40 * kMs).seconds, 0.04f);
  EXPECT_FALSE(step(0, 40 * kMs).cut);
  EXPECT_FLOAT_EQ(step(-20 * kMs, 20 * kMs).seconds, 0.04f);
  EXPECT_FALSE(step(0, 1000 * kMs).cut);
}

TEST(Timeline, FirstAndRepeatedCountAsOneThirtieth) {
  for (std::int64_t first : {kLowest, std::int64_t{0}, kHighest}) {
    Timeline timeline;
    for (int i = 0; i < 2; ++i) {
      const Timeline::Step s = timeline.advance(first);
      EXPECT_FLOAT_EQ(s.seconds, 1.0f / 30.0f);
      EXPECT_FALSE(s.cut);
    }
  }
}

TEST(Timeline, JumpsAreDiscontinuitiesOfBoundedLength) {
  for (auto [from, to] : {std::pair<std::int64_t, std::int64_t>{0, -1},
                          {0, 1000 * kMs + 1},
                          {kLowest, kHighest},
                          {kHighest, kLowest},
                          {-1, kHighest},
                          {kLowest, 0}}) {
    const Timeline::Step s = step(from, to);
    EXPECT_TRUE(s.cut) << from << " " << to;
    EXPECT_GT(s.seconds, 0.0f);
    EXPECT_LE(s.seconds, 1.0f);
  }
}

}  // namespace
}  // namespace mien::tracker
