// Converts between angles and quaternions.
#include "apps/animation/rotation.h"

#include <algorithm>
#include <cmath>

namespace mien::animation {
namespace {

constexpr double kGazeRadians = 0.485;  // rotation at a control of 1

double dot(const Quaternion& a, const Quaternion& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

}  // namespace

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

Quaternion quaternion(const Angles& angles) {
  const Quaternion yaw = {0.0, std::sin(angles.yaw / 2), 0.0, std::cos(angles.yaw / 2)};
  const Quaternion pitch = {std::sin(angles.pitch / 2), 0.0, 0.0, std::cos(angles.pitch / 2)};
  const Quaternion roll = {0.0, 0.0, std::sin(angles.roll / 2), std::cos(angles.roll / 2)};
  return product(product(yaw, pitch), roll);
}

Angles angles(const Quaternion& q) {
  const double scale = 2.0 / dot(q, q);
  const auto [x, y, z, w] = q;
  // Rows and columns of the rotation matrix R = Ry Rx Rz.
  const double r12 = std::clamp(scale * (y * z - w * x), -1.0, 1.0);
  const double r02 = scale * (x * z + w * y);
  const double r22 = 1.0 - scale * (x * x + y * y);
  const double r10 = scale * (x * y + w * z);
  const double r11 = 1.0 - scale * (x * x + z * z);
  constexpr double kNearPole = 1.0 - 1e-12;
  if (std::abs(r12) > kNearPole) {
    const double r20 = scale * (x * z - w * y);
    const double r00 = 1.0 - scale * (y * y + z * z);
    return {std::asin(-r12), std::atan2(-r20, r00), 0.0};
  }
  return {std::asin(-r12), std::atan2(r02, r22), std::atan2(r10, r11)};
}

Angles between(const Angles& a, const Angles& b, double fraction) {
  if (fraction <= 0.0 || fraction >= 1.0) {
    return fraction <= 0.0 ? a : b;
  }
  const Quaternion from = quaternion(a);
  Quaternion to = quaternion(b);
  double cosine = dot(from, to);
  if (cosine < 0.0) {  // the same rotation with the opposite sign
    for (double& part : to) {
      part = -part;
    }
    cosine = -cosine;
  }
  const double angle = std::acos(std::min(1.0, cosine));
  constexpr double kTooSmallToDivideBy = 1e-9;
  const bool tiny = angle < kTooSmallToDivideBy;
  const double of_from =
      tiny ? 1.0 - fraction : std::sin((1.0 - fraction) * angle) / std::sin(angle);
  const double of_to = tiny ? fraction : std::sin(fraction * angle) / std::sin(angle);
  Quaternion mixed;
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    mixed[i] = of_from * from[i] + of_to * to[i];
  }
  return angles(mixed);
}

std::optional<std::array<Angles, 2>> gaze(
    const std::array<double, formats::kControlCount>& controls) {
  bool any = false;
  const auto look = [&](std::size_t there, std::size_t back) {
    any = any || formats::driven(controls[there]) || formats::driven(controls[back]);
    return kGazeRadians * (formats::or_zero(controls[there]) - formats::or_zero(controls[back]));
  };
  std::array<Angles, 2> eyes;
  eyes[0].pitch = look(formats::control("eyeLookDownLeft"), formats::control("eyeLookUpLeft"));
  eyes[0].yaw = look(formats::control("eyeLookOutLeft"), formats::control("eyeLookInLeft"));
  eyes[1].pitch = look(formats::control("eyeLookDownRight"), formats::control("eyeLookUpRight"));
  eyes[1].yaw = look(formats::control("eyeLookInRight"), formats::control("eyeLookOutRight"));
  return any ? std::optional(eyes) : std::nullopt;
}

}  // namespace mien::animation
