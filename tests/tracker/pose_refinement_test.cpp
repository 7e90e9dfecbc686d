// Tests of the refinement of head poses by landmarks.
#include "tracker/geometry/pose_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace mien::tracker {
namespace {

constexpr Camera kCamera = {500.0f, {320.0f, 240.0f}};

std::array<float, kHeadPoints> head_points() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> coordinate(-0.08f, 0.08f);
  std::array<float, kHeadPoints> points = {};
  for (float& value : points) {
    value = coordinate(random);
  }
  return points;
}

Matrix3 about_y(float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
}

Matrix3 about_x(float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
}

Landmarks projected(HeadPoints head, const HeadPose& pose) {
  Landmarks landmarks;
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    const Vector3 at_rest = {head[3 * i], head[3 * i + 1], head[3 * i + 2]};
    const Vector3 p = sum(product(pose.rotation, at_rest), pose.translation);
    landmarks[i] = {kCamera.principal.x - kCamera.focal_px * p[0] / p[2],
                    kCamera.principal.y + kCamera.focal_px * p[1] / p[2]};
  }
  return landmarks;
}

float angle_between(const Matrix3& a, const Matrix3& b) {
  float trace = 0.0f;
  for (std::size_t i = 0; i < 3; ++i) {
    trace += dot(a[i], b[i]);
  }
  return std::acos(std::clamp((trace - 1.0f) / 2.0f, -1.0f, 1.0f));
}

float distance(const Vector3& a, const Vector3& b) {
  const Vector3 between = sum(a, scaled(b, -1.0f));
  return std::sqrt(dot(between, between));
}

class PoseRefinement : public testing::Test {
 protected:
  const std::array<float, kHeadPoints> head_ = head_points();
  const HeadPose true_ = {product(about_y(0.4f), about_x(-0.2f)), {0.05f, -0.03f, -0.6f}};
  const Landmarks landmarks_ = projected(head_, true_);
  const HeadPose guess_ = {product(product(about_y(0.1f), about_x(0.08f)), true_.rotation),
                           {0.07f, -0.02f, -0.66f}};
};

TEST_F(PoseRefinement, OneStepRemovesMostOfTheError) {
  HeadPose pose = guess_;
  refine_head_pose(head_, landmarks_, kCamera, pose);
  EXPECT_LT(angle_between(pose.rotation, true_.rotation),
            0.35f * angle_between(guess_.rotation, true_.rotation));
  EXPECT_LT(distance(pose.translation, true_.translation),
            0.25f * distance(guess_.translation, true_.translation));
}

// The penalty for rotation starts anew with each step, so that many steps converge to the truth.
TEST_F(PoseRefinement, StepsConvergeToTheTruePose) {
  HeadPose pose = guess_;
  for (int i = 0; i < 30; ++i) {
    refine_head_pose(head_, landmarks_, kCamera, pose);
  }
  EXPECT_LT(angle_between(pose.rotation, true_.rotation), 1e-3f);
  EXPECT_LT(distance(pose.translation, true_.translation), 1e-4f);
}

TEST_F(PoseRefinement, KeepsTheTruePose) {
  HeadPose pose = true_;
  refine_head_pose(head_, landmarks_, kCamera, pose);
  EXPECT_LT(angle_between(pose.rotation, true_.rotation), 1e-3f);
  EXPECT_LT(distance(pose.translation, true_.translation), 1e-5f);
}

// Points that all lie at the head's origin do not determine its rotation.
TEST_F(PoseRefinement, KeepsRotationThatPointsDoNotDetermine) {
  const std::array<float, kHeadPoints> nothing = {};
  HeadPose pose = guess_;
  refine_head_pose(nothing, projected(nothing, true_), kCamera, pose);
  EXPECT_LT(angle_between(pose.rotation, guess_.rotation), 1e-3f);
}

TEST_F(PoseRefinement, KeepsThePoseBitForBitWithoutAValidStep) {
  const auto expect_unchanged = [&](HeadPoints head, const Landmarks& landmarks,
                                    const HeadPose& before) {
    HeadPose pose = before;
    refine_head_pose(head, landmarks, kCamera, pose);
    EXPECT_EQ(pose.rotation, before.rotation);
    EXPECT_EQ(pose.translation, before.translation);
  };
  expect_unchanged({}, landmarks_, guess_);
  Landmarks broken = landmarks_;
  broken[3].x = std::numeric_limits<float>::quiet_NaN();
  expect_unchanged(head_, broken, guess_);
  broken[3].x = std::numeric_limits<float>::infinity();
  expect_unchanged(head_, broken, guess_);
  broken[3].x = 1e25f;  // the step is finite, its square is not
  expect_unchanged(head_, broken, guess_);
  broken[3].x = 1e12f;  // finite, but an implausible distance
  expect_unchanged(head_, broken, guess_);
  HeadPose behind = guess_;
  behind.translation[2] = -0.05f;  // some points are behind the camera
  expect_unchanged(head_, landmarks_, behind);
}

}  // namespace
}  // namespace mien::tracker
