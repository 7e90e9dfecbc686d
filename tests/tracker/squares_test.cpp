// Tests of overlap and non-maximum suppression.
#include "tracker/detection/squares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace mien::tracker {
namespace {

TEST(IntersectionOverUnion, KnownSquares) {
  const Square unit = {{0.5f, 0.5f}, 1.0f};
  EXPECT_FLOAT_EQ(intersection_over_union(unit, unit), 1.0f);
  EXPECT_FLOAT_EQ(intersection_over_union(unit, {{1.0f, 0.5f}, 1.0f}), 1.0f / 3.0f);
  EXPECT_FLOAT_EQ(intersection_over_union(unit, {{0.5f, 0.5f}, 2.0f}), 0.25f);
  EXPECT_EQ(intersection_over_union(unit, {{1.5f, 0.5f}, 1.0f}), 0.0f) << "touching";
  EXPECT_EQ(intersection_over_union(unit, {{5.0f, 5.0f}, 1.0f}), 0.0f);
  EXPECT_EQ(intersection_over_union({{1, 1}, 0}, {{1, 1}, 0}), 0.0f) << "empty";
}

std::vector<Detection> random_candidates(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<Detection> detections(count);
  for (Detection& c : detections) {
    c = {{{unit(random), unit(random)}, 0.1f + 0.3f * unit(random)}, unit(random)};
  }
  return detections;
}

TEST(SuppressNonMaxima, KeepsExactlyTheMaxima) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const std::vector<Detection> all = random_candidates(60, seed);
    std::vector<Detection> list = all;
    const std::size_t kept = suppress_non_maxima(list, 0.4f);
    ASSERT_GE(kept, 1u);
    for (std::size_t i = 0; i < kept; ++i) {
      for (std::size_t j = i + 1; j < kept; ++j) {
        EXPECT_GE(list[i].score, list[j].score);
        EXPECT_LE(intersection_over_union(list[i].square, list[j].square), 0.4f);
      }
    }
    // Each is kept, or suppressed by a kept one with a higher score.
    for (const Detection& detection : all) {
      bool explained = false;
      for (std::size_t i = 0; i < kept && !explained; ++i) {
        const bool same = list[i].score == detection.score;
        explained = same || (list[i].score > detection.score &&
                             intersection_over_union(list[i].square, detection.square) > 0.4f);
      }
      EXPECT_TRUE(explained);
    }
  }
}

TEST(SuppressNonMaxima, HandlesEmptyAndEqualInput) {
  std::vector<Detection> none;
  EXPECT_EQ(suppress_non_maxima(none, 0.5f), 0u);
  std::vector<Detection> twins(2, Detection{{{1, 1}, 1}, 0.9f});
  EXPECT_EQ(suppress_non_maxima(twins, 0.5f), 1u);
}

TEST(BestDetections, KeepsTheBestOfAnyNumber) {
  for (std::size_t offered : {0u, 3u, 10u, 11u, 200u}) {
    std::vector<Detection> all = random_candidates(offered, 9);
    std::vector<Detection> memory(10);
    BestDetections best(memory);
    for (const Detection& detection : all) {
      best.offer(detection);
    }
    const auto by_score = [](const Detection& a, const Detection& b) { return a.score > b.score; };
    std::sort(all.begin(), all.end(), by_score);
    std::vector<Detection> kept(best.kept().begin(), best.kept().end());
    std::sort(kept.begin(), kept.end(), by_score);
    ASSERT_EQ(kept.size(), std::min<std::size_t>(offered, 10));
    for (std::size_t i = 0; i < kept.size(); ++i) {
      EXPECT_EQ(kept[i].score, all[i].score);
    }
  }
  BestDetections none({});
  none.offer({{}, 1.0f});
  EXPECT_TRUE(none.kept().empty());
}

}  // namespace
}  // namespace mien::tracker
