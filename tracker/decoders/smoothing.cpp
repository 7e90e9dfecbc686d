#include "tracker/decoders/smoothing.h"

#include <algorithm>

namespace mien::tracker {
namespace {

float distance(const Vector3& a, const Vector3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

Quaternion towards(const Quaternion& from, Quaternion to, float seconds) {
  float cosine = from.x * to.x + from.y * to.y + from.z * to.z + from.w * to.w;
  if (cosine < 0.0f) {
    to = {-to.x, -to.y, -to.z, -to.w};
    cosine = -cosine;
  }
  const float angle = 2.0f * std::acos(std::min(cosine, 1.0f));
  const float share = kRotationSmoothing.share(angle, seconds);
  const auto mix = [share](float a, float b) { return a + share * (b - a); };
  const Quaternion q = {mix(from.x, to.x), mix(from.y, to.y), mix(from.z, to.z), mix(from.w, to.w)};
  const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x / length, q.y / length, q.z / length, q.w / length};
}

}  // namespace

void smooth_controls(std::span<const float> seen, float seconds, std::span<float> shown) {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const float step = seen[i] - shown[i];
    shown[i] += kControlSmoothing.share(std::abs(step), seconds) * step;
  }
}

void smooth_points(std::span<const Point> seen, float side, float seconds, std::span<Point> shown) {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Point step = {seen[i].x - shown[i].x, seen[i].y - shown[i].y};
    const float share = kLandmarkSmoothing.share(std::hypot(step.x, step.y) / side, seconds);
    shown[i] = {shown[i].x + share * step.x, shown[i].y + share * step.y};
  }
}

void smooth_pose(const HeadPose& seen, float seconds, HeadPose& shown) {
  shown.rotation = matrix(towards(quaternion(shown.rotation), quaternion(seen.rotation), seconds));
  const float share =
      kTranslationSmoothing.share(distance(seen.translation, shown.translation), seconds);
  for (std::size_t i = 0; i < 3; ++i) {
    shown.translation[i] += share * (seen.translation[i] - shown.translation[i]);
  }
}

}  // namespace mien::tracker
