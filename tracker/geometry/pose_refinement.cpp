// Refines a head pose with one Gauss-Newton step.
#include "tracker/geometry/pose_refinement.h"

#include <array>
#include <cmath>

#include "tracker/geometry/vector3.h"

namespace mien::tracker {
namespace {

// Weight of the squared rotation against the squared distances of the points. Chosen on rendered
// people of the validation set and on videos of one speaker (docs/results/training_history.md).
constexpr float kRotationWeight = 0.01f * static_cast<float>(kLandmarks);
constexpr std::size_t kUnknowns = 6;  // rotation about x, y, z, radians; translation, kHeadMetres

using Row = std::array<float, kUnknowns>;

// The normal equations of the least-squares problem.
class NormalEquations {
 public:
  explicit NormalEquations(float rotation_weight) {
    for (std::size_t i = 0; i < 3; ++i) {
      square_[i][i] = rotation_weight;
    }
  }

  // `change`: derivatives of the residual with respect to the unknowns.
  void add(const Row& change, float residual) {
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        square_[i][j] += change[i] * change[j];
      }
      right_[i] -= change[i] * residual;
    }
  }

  // Solves by Cholesky decomposition. False if the solution is not unique or not finite.
  [[nodiscard]] bool solve(Row& unknowns) {
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        float remainder = square_[i][j];
        for (std::size_t k = 0; k < j; ++k) {
          remainder -= square_[i][k] * square_[j][k];
        }
        if (i == j && !(remainder > 0.0f)) {
          return false;
        }
        square_[i][j] = i == j ? std::sqrt(remainder) : remainder / square_[j][j];
      }
    }
    unknowns = right_;
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        unknowns[i] -= square_[i][k] * unknowns[k];
      }
      unknowns[i] /= square_[i][i];
    }
    for (std::size_t left = kUnknowns; left > 0; --left) {
      const std::size_t i = left - 1;
      for (std::size_t k = i + 1; k < kUnknowns; ++k) {
        unknowns[i] -= square_[k][i] * unknowns[k];
      }
      unknowns[i] /= square_[i][i];
    }
    return all_finite(unknowns);
  }

 private:
  std::array<Row, kUnknowns> square_ = {};  // the lower triangle
  Row right_ = {};
};

// Derivatives of a residual with respect to the unknowns. `change`: its derivative with respect to
// the point's position; `arm`: the point relative to the head's origin.
Row row(const Vector3& arm, const Vector3& change) {
  const Vector3 rotation_vector = cross(arm, change);
  return {rotation_vector[0],      rotation_vector[1],      rotation_vector[2],
          kHeadMetres * change[0], kHeadMetres * change[1], kHeadMetres * change[2]};
}

// Rodrigues' formula: rotates about `rotation_vector` by its length in radians.
Matrix3 rotation_by(const Vector3& rotation_vector) {
  const float angle = std::sqrt(dot(rotation_vector, rotation_vector));
  if (!(angle > 0.0f)) {
    return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  }
  const Vector3 axis = scaled(rotation_vector, 1.0f / angle);
  const float x = axis[0], y = axis[1], z = axis[2];
  const float c = std::cos(angle), s = std::sin(angle), k = 1.0f - c;
  return {{{c + k * x * x, k * x * y - s * z, k * x * z + s * y},
           {k * x * y + s * z, c + k * y * y, k * y * z - s * x},
           {k * x * z - s * y, k * y * z + s * x, c + k * z * z}}};
}

}  // namespace

void refine_head_pose(HeadPoints head, const Landmarks& landmarks, const Camera& camera,
                      HeadPose& pose) {
  if (head.size() != kHeadPoints) {
    return;
  }
  const float pixels_per_head = camera.focal_px * kHeadMetres / -pose.translation[2];
  NormalEquations equations(kRotationWeight);
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    const Vector3 at_rest = {head[3 * i], head[3 * i + 1], head[3 * i + 2]};
    const Vector3 arm = product(pose.rotation, at_rest);
    const Vector3 point = sum(arm, pose.translation);
    const float distance = -point[2];
    if (!(distance > 0.0f)) {
      return;
    }
    const float pixels_per_metre = camera.focal_px / distance;
    const float x = camera.principal.x + point[0] * pixels_per_metre - landmarks[i].x;
    const float y = camera.principal.y - point[1] * pixels_per_metre - landmarks[i].y;
    const float change = pixels_per_metre / pixels_per_head;
    equations.add(row(arm, {change, 0.0f, change * point[0] / distance}), x / pixels_per_head);
    equations.add(row(arm, {0.0f, -change, -change * point[1] / distance}), y / pixels_per_head);
  }
  Row step;
  if (!equations.solve(step)) {
    return;
  }
  const HeadPose refined = {
      product(rotation_by({step[0], step[1], step[2]}), pose.rotation),
      sum(pose.translation, scaled({step[3], step[4], step[5]}, kHeadMetres))};
  if (is_plausible(refined)) {
    pose = refined;
  }
}

}  // namespace mien::tracker
