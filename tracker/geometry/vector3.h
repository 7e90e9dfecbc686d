// Vectors and matrices of three dimensions.
#pragma once

#include <array>
#include <cstddef>

namespace mien::tracker {

using Vector3 = std::array<float, 3>;
using Matrix3 = std::array<Vector3, 3>;  // rows

[[nodiscard]] inline Vector3 sum(const Vector3& a, const Vector3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

[[nodiscard]] inline Vector3 scaled(const Vector3& v, float factor) {
  return {v[0] * factor, v[1] * factor, v[2] * factor};
}

[[nodiscard]] inline float dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

[[nodiscard]] inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

[[nodiscard]] inline Vector3 product(const Matrix3& a, const Vector3& v) {
  return {dot(a[0], v), dot(a[1], v), dot(a[2], v)};
}

[[nodiscard]] inline Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 out = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    }
  }
  return out;
}

}  // namespace mien::tracker
