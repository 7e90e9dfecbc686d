// Tests of downscaling.
#include "tracker/image/shrink.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace mien::tracker {
namespace {

std::vector<float> random_picture(int side) {
  std::mt19937 random(static_cast<unsigned>(side));
  std::uniform_real_distribution<float> value(-1.0f, 1.0f);
  std::vector<float> picture(static_cast<std::size_t>(3 * side * side));
  std::generate(picture.begin(), picture.end(), [&] { return value(random); });
  return picture;
}

std::vector<float> shrunk(const std::vector<float>& picture, int from, int to) {
  std::vector<float> smaller(static_cast<std::size_t>(3 * to * to) + 1, 77.0f);
  std::vector<float> scratch(static_cast<std::size_t>(3 * from) + 1, 77.0f);
  shrink(picture, from, std::span(smaller).first(smaller.size() - 1), to,
         std::span(scratch).first(scratch.size() - 1));
  EXPECT_EQ(smaller.back(), 77.0f);
  EXPECT_EQ(scratch.back(), 77.0f);
  smaller.pop_back();
  return smaller;
}

double sum(const std::vector<float>& values, std::size_t channel) {
  double total = 0.0;
  for (std::size_t i = channel; i < values.size(); i += 3) {
    total += values[i];
  }
  return total;
}

TEST(Shrink, SameSizeCopiesTheImage) {
  const std::vector<float> picture = random_picture(20);
  EXPECT_EQ(shrunk(picture, 20, 20), picture);
}

TEST(Shrink, HalvingTakesTheMeanOfFourPixels) {
  const std::vector<float> picture = random_picture(12);
  const std::vector<float> half = shrunk(picture, 12, 6);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      for (std::size_t c = 0; c < 3; ++c) {
        const auto at = [&](std::size_t y, std::size_t x) { return picture[(y * 12 + x) * 3 + c]; };
        const float mean = (at(2 * i, 2 * j) + at(2 * i, 2 * j + 1) + at(2 * i + 1, 2 * j) +
                            at(2 * i + 1, 2 * j + 1)) /
                           4;
        EXPECT_NEAR(half[(i * 6 + j) * 3 + c], mean, 1e-6f);
      }
    }
  }
}

// Area averaging keeps the mean at any ratio.
TEST(Shrink, KeepsTheMean) {
  for (auto [from, to] : {std::pair{160, 113}, {113, 80}, {14, 12}, {17, 12}, {24, 1}, {5, 5}}) {
    const std::vector<float> picture = random_picture(from);
    const std::vector<float> smaller = shrunk(picture, from, to);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(sum(smaller, c) / (to * to), sum(picture, c) / (from * from), 1e-5) << from;
    }
  }
}

TEST(Shrink, KeepsPositions) {
  // A ramp stays a ramp: pixel centres map to pixel centres.
  std::vector<float> ramp(3 * 40 * 40);
  for (std::size_t i = 0; i < ramp.size(); ++i) {
    ramp[i] = static_cast<float>(i / 3 % 40) + 0.5f;
  }
  const std::vector<float> smaller = shrunk(ramp, 40, 28);
  for (std::size_t i = 0; i < smaller.size(); ++i) {
    EXPECT_NEAR(smaller[i], (static_cast<float>(i / 3 % 28) + 0.5f) * 40.0f / 28.0f, 0.1f);
  }
}

}  // namespace
}  // namespace mien::tracker
