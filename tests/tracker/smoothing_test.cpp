// Tests of the smoothing of controls, landmarks and head poses.
#include "tracker/decoders/smoothing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>
#include <vector>

namespace mien::tests {
namespace {

using namespace mien::tracker;

constexpr float kFrame = 1.0f / 30.0f;

std::vector<float> smoothed(const std::vector<float>& curve) {
  std::vector<float> out;
  float shown = curve[0];
  for (const float raw : curve) {
    smooth_controls({&raw, 1}, kFrame, {&shown, 1});
    out.push_back(shown);
  }
  return out;
}

// Minimum-jerk closing and opening, with the number of frames of a fast blink.
std::vector<float> blink(int closing, int held, int opening) {
  const auto ease = [](float t) { return t * t * t * (10 - 15 * t + 6 * t * t); };
  std::vector<float> curve(5, 0.0f);
  for (int i = 1; i <= closing; ++i) {
    curve.push_back(ease(static_cast<float>(i) / static_cast<float>(closing)));
  }
  curve.insert(curve.end(), static_cast<std::size_t>(held), 1.0f);
  for (int i = 1; i <= opening; ++i) {
    curve.push_back(1 - ease(static_cast<float>(i) / static_cast<float>(opening)));
  }
  curve.insert(curve.end(), 5, 0.0f);
  return curve;
}

// The frame, with fraction, at which a curve rises above one half.
float rise(const std::vector<float>& curve) {
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (curve[i] >= 0.5f) {
      return static_cast<float>(i - 1) + (0.5f - curve[i - 1]) / (curve[i] - curve[i - 1]);
    }
  }
  return 1e9f;
}

TEST(Smoothing, BlinksKeepTheirPeakAndTiming) {
  for (int closing = 2; closing <= 4; ++closing) {
    for (int held = 0; held <= 1; ++held) {
      const std::vector<float> raw = blink(closing, held, closing + 1), shown = smoothed(raw);
      EXPECT_GE(*std::ranges::max_element(shown), 0.95f) << closing << " frames, held " << held;
      EXPECT_LT(rise(shown) - rise(raw), 0.5f);
    }
  }
}

TEST(Smoothing, ReducesJitter) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0f, 0.01f);
  std::vector<float> raw(3000);
  std::ranges::generate(raw, [&] { return 0.4f + noise(random); });
  const std::vector<float> shown = smoothed(raw);
  const auto travel = [](const std::vector<float>& curve) {
    float sum = 0.0f;
    for (std::size_t i = 1; i < curve.size(); ++i) {
      sum += std::abs(curve[i] - curve[i - 1]);
    }
    return sum;
  };
  EXPECT_LT(travel(shown), 0.5f * travel(raw));
  EXPECT_NEAR(shown.back(), 0.4f, 0.03f);
}

TEST(Smoothing, ConvergesToTheInput) {
  std::vector<float> raw(120, 1.0f);
  raw[0] = 0.98f;
  EXPECT_NEAR(smoothed(raw).back(), 1.0f, 1e-3f);
}

TEST(Smoothing, PointsDoNotDependOnTheImageSize) {
  const Point from = {10.0f, 20.0f}, step = {0.5f, -0.25f};
  for (const float size : {1.0f, 8.0f}) {
    Point shown = {size * from.x, size * from.y};
    const Point raw = {size * (from.x + step.x), size * (from.y + step.y)};
    smooth_points({&raw, 1}, 100.0f * size, kFrame, {&shown, 1});
    EXPECT_NEAR((shown.x / size - from.x) / step.x, (shown.y / size - from.y) / step.y, 1e-4f);
    EXPECT_NEAR(shown.x / size, 10.3f, 0.1f);
  }
}

TEST(Smoothing, PosesStayRotationsAndTakeTheShorterWay) {
  HeadPose shown, raw;
  const float angle = 3.0f;
  raw.rotation = matrix({0.0f, std::sin(angle / 2), 0.0f, std::cos(angle / 2)});
  raw.translation = {0.1f, 0.0f, -0.5f};
  for (int i = 0; i < 200; ++i) {
    smooth_pose(raw, kFrame, shown);
    const Quaternion q = quaternion(shown.rotation);
    EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0f, 1e-4f);
    EXPECT_GE(q.y, 0.0f);
  }
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      EXPECT_NEAR(shown.rotation[row][column], raw.rotation[row][column], 2e-3f);
    }
    EXPECT_NEAR(shown.translation[row], raw.translation[row], 2e-3f);
  }
}

// Smoothing does not depend on the direction of the head, also where angles wrap around.
TEST(Smoothing, PosesDoNotDependOnTheDirection) {
  const auto rotation_by = [](float angle) {
    return matrix({0.0f, std::sin(angle / 2), 0.0f, std::cos(angle / 2)});
  };
  for (const float from : {0.0f, static_cast<float>(M_PI) - 0.05f}) {
    HeadPose shown, raw;
    shown.rotation = rotation_by(from);
    raw.rotation = rotation_by(from + 0.1f);
    smooth_pose(raw, kFrame, shown);
    const float alpha = kRotationSmoothing.alpha(0.1f, kFrame);
    const HeadPose expected = {rotation_by(from + alpha * 0.1f), {}};
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) {
        EXPECT_NEAR(shown.rotation[row][column], expected.rotation[row][column], 1e-3f) << from;
      }
    }
  }
}

// Fraction of a step that is visible on the first frame after it, at 30 frames per second.
struct Step {
  float size;
  float shown;
};

template <class Smooth>
void expect_shown(const char* signal, std::initializer_list<Step> steps, Smooth smooth) {
  for (const Step& step : steps) {
    EXPECT_NEAR(smooth(step.size) / step.size, step.shown, 0.02f)
        << signal << ", a step of " << step.size;
  }
}

TEST(Smoothing, PassesLargeStepsAndSlowsSmallOnes) {
  expect_shown("control", {{0.002f, 0.30f}, {0.01f, 0.52f}, {0.1f, 0.89f}, {0.3f, 0.96f}},
               [](float size) {
                 float shown = 0.0f;
                 smooth_controls({&size, 1}, kFrame, {&shown, 1});
                 return shown;
               });
  // In sides of the crop, which is 1 pixel here.
  expect_shown("landmark", {{0.0005f, 0.33f}, {0.002f, 0.52f}, {0.02f, 0.89f}, {0.06f, 0.96f}},
               [](float size) {
                 const Point raw = {0.6f * size, 0.8f * size};
                 Point shown = {0.0f, 0.0f};
                 smooth_points({&raw, 1}, 1.0f, kFrame, {&shown, 1});
                 return std::hypot(shown.x, shown.y);
               });
  expect_shown("position in metres", {{0.001f, 0.29f}, {0.01f, 0.56f}, {0.1f, 0.91f}},
               [](float size) {
                 HeadPose raw, shown;
                 raw.translation = {0.0f, 0.6f * size, -0.8f * size};
                 smooth_pose(raw, kFrame, shown);
                 return std::hypot(shown.translation[1], shown.translation[2]);
               });
  expect_shown("rotation in radians", {{0.003f, 0.37f}, {0.01f, 0.56f}, {0.1f, 0.91f}},
               [](float size) {
                 HeadPose raw, shown;
                 raw.rotation = matrix({0.0f, std::sin(size / 2), 0.0f, std::cos(size / 2)});
                 smooth_pose(raw, kFrame, shown);
                 return euler_angles(shown.rotation).yaw;
               });
}

}  // namespace
}  // namespace mien::tests
