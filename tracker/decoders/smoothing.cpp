// Smooths controls, landmarks and head pose.
#include "tracker/decoders/smoothing.h"

#include <algorithm>

namespace mien::tracker {
namespace {

float distance(const Vector3& a, const Vector3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Moves `from` towards `to` along the shorter way.
Quaternion towards(const Quaternion& from, Quaternion to, float seconds) {
  float cosine = from.x * to.x + from.y * to.y + from.z * to.z + from.w * to.w;
  if (cosine < 0.0f) {
    to = {-to.x, -to.y, -to.z, -to.w};
    cosine = -cosine;
  }
  const float angle = 2.0f * std::acos(std::min(cosine, 1.0f));
  const float alpha = kRotationSmoothing.alpha(angle, seconds);
  const auto mix = [alpha](float a, float b) { return a + alpha * (b - a); };
  const Quaternion q = {mix(from.x, to.x), mix(from.y, to.y), mix(from.z, to.z), mix(from.w, to.w)};
  const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x / length, q.y / length, q.z / length, q.w / length};
}

}  // namespace

void smooth_controls(std::span<const float> raw, float seconds, std::span<float> smoothed) {
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const float step = raw[i] - smoothed[i];
    smoothed[i] += kControlSmoothing.alpha(std::abs(step), seconds) * step;
  }
}

void smooth_points(std::span<const Point> raw, float side, float seconds,
                   std::span<Point> smoothed) {
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const Point step = {raw[i].x - smoothed[i].x, raw[i].y - smoothed[i].y};
    const float alpha = kLandmarkSmoothing.alpha(std::hypot(step.x, step.y) / side, seconds);
    smoothed[i] = {smoothed[i].x + alpha * step.x, smoothed[i].y + alpha * step.y};
  }
}

void smooth_pose(const HeadPose& raw, float seconds, HeadPose& smoothed) {
  smoothed.rotation =
      matrix(towards(quaternion(smoothed.rotation), quaternion(raw.rotation), seconds));
  const float alpha =
      kTranslationSmoothing.alpha(distance(raw.translation, smoothed.translation), seconds);
  for (std::size_t i = 0; i < 3; ++i) {
    smoothed.translation[i] += alpha * (raw.translation[i] - smoothed.translation[i]);
  }
}

}  // namespace mien::tracker
