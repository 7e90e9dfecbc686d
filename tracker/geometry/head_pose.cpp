// Decodes and converts head poses.
#include "tracker/geometry/head_pose.h"

#include <algorithm>
#include <cmath>

namespace mien::tracker {
namespace {

constexpr float kMinLength = 1e-6f;  // shorter columns have no usable direction

bool normalise(Vector3& v) {
  const float length = std::sqrt(dot(v, v));
  if (!std::isfinite(length) || !(length > kMinLength)) {
    return false;
  }
  v = scaled(v, 1.0f / length);
  return true;
}

// Gram-Schmidt on the first two columns.
bool rotation_from_columns(std::span<const float, kPoseOutputs> six, Matrix3& rotation) {
  Vector3 a = {six[0], six[1], six[2]};
  if (!normalise(a)) {
    return false;
  }
  Vector3 b = {six[3], six[4], six[5]};
  const float along = dot(a, b);
  b = {b[0] - along * a[0], b[1] - along * a[1], b[2] - along * a[2]};
  if (!normalise(b)) {
    return false;
  }
  const Vector3 c = cross(a, b);
  rotation = {{{a[0], b[0], c[0]}, {a[1], b[1], c[1]}, {a[2], b[2], c[2]}}};
  return true;
}

// The smallest rotation from (0, 0, -1) to the ray through the pixel, by Rodrigues' formula.
Matrix3 ray_rotation(Point pixel, const Camera& camera) {
  const float u = (pixel.x - camera.principal.x) / camera.focal_px;
  const float v = (camera.principal.y - pixel.y) / camera.focal_px;
  const float length = std::sqrt(u * u + v * v + 1.0f);
  const float x = u / length;
  const float y = v / length;
  const float z = -1.0f / length;
  const float k = 1.0f / (1.0f - z);
  return {{{1 - k * x * x, -k * x * y, -x}, {-k * x * y, 1 - k * y * y, -y}, {x, y, -z}}};
}

Matrix3 roll_rotation(float angle) {
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  return {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

}  // namespace

bool is_plausible(const HeadPose& pose) {
  return pose.translation[2] < 0.0f &&
         std::all_of(pose.translation.begin(), pose.translation.end(),
                     [](float metres) { return std::abs(metres) < kMaxDistanceMetres; }) &&
         std::all_of(pose.rotation.begin(), pose.rotation.end(),
                     [](const Vector3& row) { return all_finite(row); });
}

bool decode_head_pose(std::span<const float, kPoseOutputs> prediction, const Crop& crop,
                      const Camera& camera, HeadPose& pose) {
  Matrix3 in_crop;
  if (!rotation_from_columns(prediction, in_crop)) {
    return false;
  }
  const Matrix3 crop_frame = product(ray_rotation(crop.center, camera), roll_rotation(-crop.roll));
  const Point origin = crop_to_image(crop)({prediction[6] + 0.5f, prediction[7] + 0.5f});
  const float distance = camera.focal_px * kHeadMetres / (crop.side * std::exp(prediction[8]));
  const float metres_per_px = distance / camera.focal_px;
  const HeadPose decoded = {product(crop_frame, in_crop),
                            {(origin.x - camera.principal.x) * metres_per_px,
                             (camera.principal.y - origin.y) * metres_per_px, -distance}};
  if (!is_plausible(decoded)) {
    return false;
  }
  pose = decoded;
  return true;
}

EulerAngles euler_angles(const Matrix3& r) {
  return {std::asin(std::clamp(-r[1][2], -1.0f, 1.0f)), std::atan2(r[0][2], r[2][2]),
          std::atan2(r[1][0], r[1][1])};
}

// Shepperd 1978: divides by the largest of the four components, so never by a value near 0.
Quaternion quaternion(const Matrix3& r) {
  const float xx = r[0][0];
  const float yy = r[1][1];
  const float zz = r[2][2];
  const std::array<float, 4> squares = {1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz,
                                        1 + xx + yy + zz};
  const auto largest =
      static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  const float xy = r[0][1] + r[1][0];
  const float yz = r[1][2] + r[2][1];
  const float zx = r[2][0] + r[0][2];
  const float wx = r[2][1] - r[1][2];
  const float wy = r[0][2] - r[2][0];
  const float wz = r[1][0] - r[0][1];
  const std::array<Quaternion, 4> unscaled = {{{squares[0], xy, zx, wx},
                                               {xy, squares[1], yz, wy},
                                               {zx, yz, squares[2], wz},
                                               {wx, wy, wz, squares[3]}}};
  const Quaternion q = unscaled[largest];
  const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  const float factor = (q.w < 0.0f ? -1.0f : 1.0f) / length;
  return {q.x * factor, q.y * factor, q.z * factor, q.w * factor};
}

Matrix3 matrix(const Quaternion& q) {
  const float xx = 2 * q.x * q.x, yy = 2 * q.y * q.y, zz = 2 * q.z * q.z;
  const float xy = 2 * q.x * q.y, yz = 2 * q.y * q.z, zx = 2 * q.z * q.x;
  const float wx = 2 * q.w * q.x, wy = 2 * q.w * q.y, wz = 2 * q.w * q.z;
  return {{{1 - yy - zz, xy - wz, zx + wy},
           {xy + wz, 1 - xx - zz, yz - wx},
           {zx - wy, yz + wx, 1 - xx - yy}}};
}

}  // namespace mien::tracker
