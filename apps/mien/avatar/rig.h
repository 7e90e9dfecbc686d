// The bones of an avatar that an animation turns.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "apps/animation/rotation.h"
#include "apps/mien/avatar/glb.h"

namespace mien::app {

// A node with its rotations at rest.
struct Bone {
  std::size_t node = 0;
  animation::Quaternion local = {};   // of the node
  animation::Quaternion parent = {};  // of its parent in the scene

  // The node's rotation when it is turned in the scene.
  [[nodiscard]] animation::Quaternion turned(const animation::Quaternion& by) const;
};

struct Rig {
  std::optional<Bone> head;
  std::array<std::optional<Bone>, 2> eyes;  // left, right
  bool faces_back = false;                  // faces -z, as in VRM 0.x; otherwise +z

  // Converts a rotation of a frame (frame.h) to the axes of the avatar's scene.
  [[nodiscard]] animation::Quaternion in_scene(const animation::Angles& angles) const;
};

// Finds bones by the humanoid of a VRM, or by name (Head, bone:LeftEye, eye_L, and those of VRoid
// Studio and Character Creator). Throws Json::exception if nodes are malformed.
[[nodiscard]] Rig find_rig(const Json& document);

// A VRM's extension, or nullptr.
[[nodiscard]] const Json* vrm_0(const Json& document);
[[nodiscard]] const Json* vrm_1(const Json& document);

// Replaces the matrix of a node, which must not be animated, by translation, rotation and scale.
void split_matrix(Json& node);

}  // namespace mien::app
