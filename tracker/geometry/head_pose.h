// Head pose: converts the pose decoder's prediction for a crop to rotation and translation in
// camera space.
#pragma once

#include <array>
#include <span>

#include "tracker/geometry/crop.h"
#include "tracker/geometry/vector3.h"

namespace mien::tracker {

inline constexpr int kPoseOutputs = 9;
inline constexpr float kHeadMetres = 0.2f;  // size of a head, the unit of predicted distances

// A pinhole camera without distortion. It looks along -z; x points right, y up.
struct Camera {
  float focal_px = 1.0f;
  Point principal;  // pixels
};

struct HeadPose {
  Matrix3 rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // head to camera
  Vector3 translation = {0, 0, 0};                         // metres, the head's origin
};

struct EulerAngles {
  float pitch, yaw, roll;  // radians; R = Ry(yaw) Rx(pitch) Rz(roll)
};

struct Quaternion {
  float x, y, z, w;  // unit, w >= 0
};

// `prediction`: the first two columns of R_crop [6] (Zhou et al. 2019, "On the Continuity of
// Rotation Representations in Neural Networks"; orthonormalized here), the projected head origin
// minus 0.5 in crop coordinates [2], log(focal_px / distance * 0.2 m / crop side). With R_ray the
// shortest rotation from the optical axis to the ray through the crop's centre,
//   R_camera = R_ray Rz(-crop roll) R_crop.
// False, and `pose` unchanged, if the columns are collinear or the pose is not plausible.
[[nodiscard]] bool decode_head_pose(std::span<const float, kPoseOutputs> prediction,
                                    const Crop& crop, const Camera& camera, HeadPose& pose);

// Whether a pose is finite, in front of the camera and closer than kMaxDistanceMetres. The limit
// keeps smoothing far from an overflow.
inline constexpr float kMaxDistanceMetres = 1e6f;
[[nodiscard]] bool is_plausible(const HeadPose& pose);
[[nodiscard]] EulerAngles euler_angles(const Matrix3& rotation);
[[nodiscard]] Quaternion quaternion(const Matrix3& rotation);
[[nodiscard]] Matrix3 matrix(const Quaternion& unit);

}  // namespace mien::tracker
