// Tests of crops: fitting to landmarks and the map to the image.
#include "tracker/geometry/crop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace mien::tracker {
namespace {

std::vector<Point> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<Point> points(count);
  for (Point& p : points) {
    p = {unit(random), unit(random)};
  }
  return points;
}

std::vector<Point> placed(const std::vector<Point>& shape, const Crop& crop) {
  std::vector<Point> points;
  for (const Point& p : shape) {
    points.push_back(crop_to_image(crop)(p));
  }
  return points;
}

double squared_error(const std::vector<Point>& shape, const std::vector<Point>& landmarks,
                     const Crop& crop) {
  double sum = 0.0;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const Point p = crop_to_image(crop)(shape[i]);
    sum += std::pow(p.x - landmarks[i].x, 2) + std::pow(p.y - landmarks[i].y, 2);
  }
  return sum;
}

TEST(Crop, RotatesClockwiseAboutItsCentre) {
  const Crop crop = {{100.0f, 50.0f}, 20.0f, static_cast<float>(M_PI / 2)};
  const Point middle = crop_to_image(crop)({0.5f, 0.5f});
  EXPECT_NEAR(middle.x, 100.0f, 1e-4f);
  EXPECT_NEAR(middle.y, 50.0f, 1e-4f);
  // A quarter turn clockwise on the screen brings the top left corner to the top right.
  const Point top_left = crop_to_image(crop)({0.0f, 0.0f});
  EXPECT_NEAR(top_left.x, 110.0f, 1e-4f);
  EXPECT_NEAR(top_left.y, 40.0f, 1e-4f);
}

TEST(FitCrop, RecoversTheSimilarityOfTheTemplate) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  for (unsigned trial = 0; trial < 200; ++trial) {
    const std::vector<Point> shape = random_points(175, trial);
    const Crop truth = {{2000.0f * unit(random), 2000.0f * unit(random)},
                        std::exp(5.0f * unit(random) + 3.0f),
                        3.1f * unit(random)};
    Crop fitted;
    ASSERT_TRUE(fit_crop(shape, placed(shape, truth), fitted));
    EXPECT_NEAR(fitted.center.x, truth.center.x, 1e-3f + 1e-5f * truth.side);
    EXPECT_NEAR(fitted.center.y, truth.center.y, 1e-3f + 1e-5f * truth.side);
    EXPECT_NEAR(fitted.side / truth.side, 1.0f, 2e-3f);
    EXPECT_NEAR(std::remainder(fitted.roll - truth.roll, 2 * M_PI), 0.0, 2e-3);
  }
}

TEST(FitCrop, MinimizesTheErrorOfNoisyPoints) {
  const std::vector<Point> shape = random_points(175, 1);
  std::vector<Point> noisy = placed(shape, {{300.0f, 200.0f}, 120.0f, 0.4f});
  std::mt19937 random(2);
  std::normal_distribution<float> noise(0.0f, 4.0f);
  for (Point& p : noisy) {
    p = {p.x + noise(random), p.y + noise(random)};
  }
  Crop best;
  ASSERT_TRUE(fit_crop(shape, noisy, best));
  const double min_error = squared_error(shape, noisy, best);
  for (int axis = 0; axis < 4; ++axis) {
    for (float step : {-0.5f, 0.5f}) {
      Crop other = best;
      other.center.x += axis == 0 ? step : 0.0f;
      other.center.y += axis == 1 ? step : 0.0f;
      other.side += axis == 2 ? step : 0.0f;
      other.roll += axis == 3 ? step / 60.0f : 0.0f;
      EXPECT_GT(squared_error(shape, noisy, other), min_error);
    }
  }
}

TEST(FitCrop, RejectsDegenerateAndNonFinitePoints) {
  const std::vector<Point> shape = random_points(175, 3);
  const Crop before = {{1.0f, 2.0f}, 3.0f, 0.5f};
  Crop crop = before;
  EXPECT_FALSE(fit_crop(shape, std::vector<Point>(175, Point{5.0f, 5.0f}), crop));
  EXPECT_FALSE(fit_crop(std::vector<Point>(175), placed(shape, before), crop));
  for (float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::vector<Point> points = placed(shape, before);
    points[99].x = bad;
    EXPECT_FALSE(fit_crop(shape, points, crop)) << bad;
  }
  EXPECT_EQ(crop.side, before.side);
  EXPECT_EQ(crop.center.x, before.center.x);
}

TEST(Affine, ComposeAppliesInnerThenOuter) {
  const Affine outer = {2, 1, 3, -1, 4, 5};
  const Affine inner = {0.5f, -2, 7, 1, 3, -6};
  const Point p = {1.25f, -3.5f};
  const Point direct = compose(outer, inner)(p);
  const Point stepwise = outer(inner(p));
  EXPECT_FLOAT_EQ(direct.x, stepwise.x);
  EXPECT_FLOAT_EQ(direct.y, stepwise.y);
}

}  // namespace
}  // namespace mien::tracker
