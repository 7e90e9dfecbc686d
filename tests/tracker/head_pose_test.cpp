// Tests of decoding and converting head poses.
#include "tracker/geometry/head_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace mien::tracker {
namespace {

using Prediction = std::array<float, kPoseOutputs>;

Vector3 times(const Matrix3& m, const Vector3& v) {
  Vector3 out = {};
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  }
  return out;
}

Matrix3 times(const Matrix3& a, const Matrix3& b) {
  Matrix3 out = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    }
  }
  return out;
}

Matrix3 transposed(const Matrix3& m) {
  return {{{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}}};
}

// Rotation about coordinate axis 0, 1, 2 by the right-hand rule.
Matrix3 about(std::size_t axis, float angle) {
  const std::size_t i = (axis + 1) % 3;
  const std::size_t j = (axis + 2) % 3;
  Matrix3 m = {};
  m[axis][axis] = 1.0f;
  m[i][i] = m[j][j] = std::cos(angle);
  m[i][j] = -std::sin(angle);
  m[j][i] = std::sin(angle);
  return m;
}

Matrix3 from_quaternion(const Quaternion& q) {
  const float x = q.x, y = q.y, z = q.z, w = q.w;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

Matrix3 random_rotation(std::mt19937& random) {
  std::normal_distribution<float> normal;
  Quaternion q = {normal(random), normal(random), normal(random), normal(random)};
  const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return from_quaternion({q.x / length, q.y / length, q.z / length, q.w / length});
}

float difference(const Matrix3& a, const Matrix3& b) {
  float largest = 0.0f;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      largest = std::max(largest, std::abs(a[i][j] - b[i][j]));
    }
  }
  return largest;
}

// The smallest rotation between unit vectors, as two reflections: independent of the library.
Matrix3 shortest_rotation(const Vector3& from, const Vector3& to) {
  const Vector3 h = {from[0] + to[0], from[1] + to[1], from[2] + to[2]};
  const float hh = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
  Matrix3 m = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      m[i][j] = (i == j ? 1.0f : 0.0f) - 2 * h[i] * h[j] / hh;
    }
  }
  Matrix3 n = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      n[i][j] = (i == j ? 1.0f : 0.0f) - 2 * from[i] * from[j];
    }
  }
  return times(m, n);
}

struct Case {
  Camera camera;
  Crop crop;
  HeadPose pose;
};

Case random_case(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  Case c;
  c.camera = {300.0f + 600.0f * unit(random),
              {300.0f + 40.0f * unit(random), 220.0f + 40.0f * unit(random)}};
  c.crop = {{640.0f * unit(random), 480.0f * unit(random)},
            50.0f + 200.0f * unit(random),
            2.0f * unit(random) - 1.0f};
  c.pose.rotation = random_rotation(random);
  c.pose.translation = {0.6f * unit(random) - 0.3f, 0.6f * unit(random) - 0.3f,
                        -0.3f - 1.5f * unit(random)};
  return c;
}

// The exact prediction for a head in front of the camera, by the definition.
Prediction exact_prediction(const Case& c) {
  const float u = (c.crop.center.x - c.camera.principal.x) / c.camera.focal_px;
  const float v = (c.camera.principal.y - c.crop.center.y) / c.camera.focal_px;
  const float length = std::sqrt(u * u + v * v + 1);
  const Matrix3 ray = shortest_rotation({0, 0, -1}, {u / length, v / length, -1 / length});
  const Matrix3 frame = times(ray, about(2, -c.crop.roll));
  const Matrix3 in_crop = times(transposed(frame), c.pose.rotation);
  const float distance = -c.pose.translation[2];
  const float px = c.camera.principal.x + c.pose.translation[0] / distance * c.camera.focal_px;
  const float py = c.camera.principal.y - c.pose.translation[1] / distance * c.camera.focal_px;
  const float dx = (px - c.crop.center.x) / c.crop.side;
  const float dy = (py - c.crop.center.y) / c.crop.side;
  const float cosine = std::cos(c.crop.roll);
  const float sine = std::sin(c.crop.roll);
  return {in_crop[0][0],
          in_crop[1][0],
          in_crop[2][0],
          in_crop[0][1],
          in_crop[1][1],
          in_crop[2][1],
          cosine * dx + sine * dy,
          -sine * dx + cosine * dy,
          std::log(c.camera.focal_px / distance * 0.2f / c.crop.side)};
}

TEST(HeadPose, DecodesAnExactPrediction) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 500; ++trial) {
    const Case c = random_case(random);
    HeadPose pose;
    ASSERT_TRUE(decode_head_pose(exact_prediction(c), c.crop, c.camera, pose));
    EXPECT_LT(difference(pose.rotation, c.pose.rotation), 2e-5f);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(pose.translation[i], c.pose.translation[i], 2e-4f);
    }
  }
}

TEST(HeadPose, OrthonormalizesColumns) {
  std::mt19937 random(2);
  const Case c = random_case(random);
  Prediction p = exact_prediction(c);
  for (std::size_t i = 0; i < 3; ++i) {
    p[3 + i] = 0.3f * p[3 + i] + 0.2f * p[i];
    p[i] *= 7.0f;
  }
  HeadPose pose;
  ASSERT_TRUE(decode_head_pose(p, c.crop, c.camera, pose));
  EXPECT_LT(difference(pose.rotation, c.pose.rotation), 1e-5f);
}

TEST(HeadPose, FrontalHeadAtTheImageCentreHasNoRotation) {
  const Camera camera = {500.0f, {320.0f, 240.0f}};
  const Prediction frontal = {1, 0, 0, 0, 1, 0, 0, 0, 0};
  HeadPose pose;
  ASSERT_TRUE(decode_head_pose(frontal, {{320.0f, 240.0f}, 100.0f, 0.0f}, camera, pose));
  EXPECT_LT(difference(pose.rotation, HeadPose().rotation), 1e-6f);
  EXPECT_NEAR(pose.translation[2], -1.0f, 1e-6f);  // 500 px * 0.2 m / 100 px
  // A clockwise rotation on the screen is negative about z, which points to the viewer.
  ASSERT_TRUE(decode_head_pose(frontal, {{320.0f, 240.0f}, 100.0f, 0.3f}, camera, pose));
  EXPECT_NEAR(euler_angles(pose.rotation).roll, -0.3f, 1e-6f);
}

TEST(HeadPose, RejectsImplausiblePredictions) {
  const Camera camera = {500.0f, {320.0f, 240.0f}};
  const Crop crop = {{300.0f, 200.0f}, 100.0f, 0.1f};
  const Prediction good = {1, 0, 0, 0, 1, 0, 0, 0, 0};
  HeadPose pose;
  pose.translation = {1, 2, 3};
  const auto rejected = [&](std::size_t index, float value) {
    Prediction p = good;
    p[index] = value;
    return !decode_head_pose(p, crop, camera, pose);
  };
  EXPECT_TRUE(rejected(0, 0.0f)) << "no first column";
  EXPECT_TRUE(rejected(4, 0.0f)) << "no second column";
  for (std::size_t i = 0; i < good.size(); ++i) {
    EXPECT_TRUE(rejected(i, std::numeric_limits<float>::quiet_NaN())) << i;
    EXPECT_TRUE(rejected(i, -std::numeric_limits<float>::infinity())) << i;
  }
  EXPECT_FALSE(decode_head_pose(Prediction{1, 0, 0, 2, 0, 0, 0, 0, 0}, crop, camera, pose))
      << "collinear columns";
  EXPECT_TRUE(rejected(6, 1e9f)) << "too far to the side";
  EXPECT_TRUE(rejected(8, -30.0f)) << "too far away";
  EXPECT_EQ(pose.translation[2], 3.0f);
}

TEST(EulerAngles, RoundTripWithTheDocumentedSigns) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 500; ++trial) {
    const Matrix3 r = random_rotation(random);
    const EulerAngles e = euler_angles(r);
    EXPECT_LT(difference(times(times(about(1, e.yaw), about(0, e.pitch)), about(2, e.roll)), r),
              2e-3f);
  }
  const Vector3 out_of_face = {0, 0, 1};
  EXPECT_LT(times(about(0, 0.3f), out_of_face)[1], 0.0f);  // pitch > 0 looks down
  EXPECT_GT(times(about(1, 0.3f), out_of_face)[0], 0.0f);  // yaw > 0: subject's left, image right
  EXPECT_NEAR(euler_angles(about(0, 0.3f)).pitch, 0.3f, 1e-6f);
  EXPECT_NEAR(euler_angles(about(1, 0.3f)).yaw, 0.3f, 1e-6f);
  EXPECT_NEAR(euler_angles(about(2, 0.3f)).roll, 0.3f, 1e-6f);
}

TEST(Quaternion, IsAUnitQuaternionWithNonNegativeW) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 500; ++trial) {
    const Matrix3 r = random_rotation(random);
    const Quaternion q = quaternion(r);
    EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0f, 1e-5f);
    EXPECT_GE(q.w, 0.0f);
    EXPECT_LT(difference(from_quaternion(q), r), 1e-5f);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {  // half turns: w = 0
    const Matrix3 half = about(axis, static_cast<float>(M_PI));
    EXPECT_LT(difference(from_quaternion(quaternion(half)), half), 1e-5f);
  }
}

}  // namespace
}  // namespace mien::tracker
