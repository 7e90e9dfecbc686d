// Finds the bones of avatars and turns them about the axes of the scene.
#include "apps/mien/avatar/rig.h"

#include <cmath>

#include "formats/vocabulary/plain_name.h"

namespace mien::app {
namespace {

using animation::Quaternion;

constexpr Quaternion kNoRotation = {0.0, 0.0, 0.0, 1.0};

Quaternion inverse(const Quaternion& q) { return {-q[0], -q[1], -q[2], q[3]}; }

// Axes of the upper 3 x 3 part of a glTF matrix [16], and their lengths.
struct Axes {
  std::array<std::array<double, 3>, 3> of = {};
  std::array<double, 3> lengths = {};
};

Axes axes_of(const std::array<double, 16>& matrix) {
  Axes result;
  for (std::size_t c = 0; c < 3; ++c) {
    const double* column = matrix.data() + 4 * c;
    const double length = std::hypot(column[0], column[1], column[2]);
    result.lengths[c] = length;
    for (std::size_t r = 0; r < 3; ++r) {
      result.of[c][r] = length > 0.0 ? column[r] / length : (r == c ? 1.0 : 0.0);
    }
  }
  return result;
}

// Shepperd's method: divides by the largest of the four components.
Quaternion rotation_of(const Axes& m) {
  const auto at = [&](std::size_t row, std::size_t column) { return m.of[column][row]; };
  const double trace = at(0, 0) + at(1, 1) + at(2, 2);
  if (trace > 0.0) {
    const double s = 2.0 * std::sqrt(1.0 + trace);
    return {(at(2, 1) - at(1, 2)) / s, (at(0, 2) - at(2, 0)) / s, (at(1, 0) - at(0, 1)) / s, s / 4};
  }
  const std::size_t i =
      at(1, 1) > at(0, 0) ? (at(2, 2) > at(1, 1) ? 2u : 1u) : (at(2, 2) > at(0, 0) ? 2u : 0u);
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  const double s = 2.0 * std::sqrt(std::max(0.0, 1.0 + at(i, i) - at(j, j) - at(k, k)));
  Quaternion q = kNoRotation;
  if (s > 0.0) {
    q[i] = s / 4;
    q[j] = (at(j, i) + at(i, j)) / s;
    q[k] = (at(k, i) + at(i, k)) / s;
    q[3] = (at(k, j) - at(j, k)) / s;
  }
  return q;
}

Quaternion rotation_of(const Json& node) {
  if (node.contains("matrix")) {
    return rotation_of(axes_of(node.at("matrix").get<std::array<double, 16>>()));
  }
  return node.value("rotation", kNoRotation);
}

// Nodes and their parents.
class Tree {
 public:
  explicit Tree(const Json& document)
      : nodes_(document.at("nodes")), parents_(nodes_.size()), bones_(nodes_.size()) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      for (const Json& child : nodes_.at(i).value("children", Json::array())) {
        parents_.at(child.get<std::size_t>()) = i;
      }
    }
    for (const Json& skin : document.value("skins", Json::array())) {
      for (const Json& joint : skin.value("joints", Json::array())) {
        bones_.at(joint.get<std::size_t>()) = true;
      }
    }
  }

  [[nodiscard]] Bone bone(std::size_t node) const {
    Bone found = {node, rotation_of(nodes_.at(node)), kNoRotation};
    std::size_t steps = 0;  // a cycle is invalid, but must not be endless
    for (auto at = parents_.at(node); at && steps < nodes_.size(); at = parents_[*at], ++steps) {
      found.parent = animation::product(rotation_of(nodes_.at(*at)), found.parent);
    }
    return found;
  }

  // The node with one of these plain names, preferably a joint of a skin.
  [[nodiscard]] std::optional<Bone> named(const std::vector<std::string>& names) const {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const std::string name = nodes_.at(i).value("name", "");
      const formats::PlainName plain(name);
      const bool matches = std::find(names.begin(), names.end(), plain.text()) != names.end();
      if (matches && (!found || (bones_[i] && !bones_[*found]))) {
        found = i;
      }
    }
    return found ? std::optional(bone(*found)) : std::nullopt;
  }

 private:
  const Json& nodes_;
  std::vector<std::optional<std::size_t>> parents_;
  std::vector<bool> bones_;
};

const Json* extension(const Json& document, const char* name) {
  const auto extensions = document.find("extensions");
  if (extensions == document.end() || !extensions->contains(name)) {
    return nullptr;
  }
  return &extensions->at(name);
}

// The node of a bone in the humanoid of a VRM.
std::optional<std::size_t> humanoid_node(const Json& document, const char* bone) {
  if (const Json* vrm = vrm_1(document)) {
    const Json& bones = vrm->at("humanoid").at("humanBones");
    return bones.contains(bone) ? std::optional(bones.at(bone).at("node").get<std::size_t>())
                                : std::nullopt;
  }
  if (const Json* vrm = vrm_0(document)) {
    for (const Json& entry : vrm->at("humanoid").at("humanBones")) {
      if (entry.value("bone", "") == bone) {
        return entry.at("node").get<std::size_t>();
      }
    }
  }
  return std::nullopt;
}

}  // namespace

Quaternion Bone::turned(const Quaternion& by) const {
  return animation::product(inverse(parent),
                            animation::product(by, animation::product(parent, local)));
}

Quaternion Rig::in_scene(const animation::Angles& angles) const {
  const auto [x, y, z, w] = animation::quaternion(angles);
  return faces_back ? Quaternion{-x, y, -z, w} : Quaternion{x, y, z, w};
}

const Json* vrm_0(const Json& document) { return extension(document, "VRM"); }
const Json* vrm_1(const Json& document) { return extension(document, "VRMC_vrm"); }

Rig find_rig(const Json& document) {
  Rig rig;
  rig.faces_back = vrm_0(document) != nullptr;
  const Tree tree(document);
  const auto find = [&](const char* humanoid, const std::vector<std::string>& names) {
    const std::optional<std::size_t> node = humanoid_node(document, humanoid);
    return node ? std::optional(tree.bone(*node)) : tree.named(names);
  };
  rig.head = find("head", {"head", "jbipchead", "ccbasehead"});
  rig.eyes = {find("leftEye", {"lefteye", "eyeleft"}), find("rightEye", {"righteye", "eyeright"})};
  return rig;
}

void split_matrix(Json& node) {
  if (!node.contains("matrix")) {
    return;
  }
  const auto matrix = node.at("matrix").get<std::array<double, 16>>();
  const Axes parts = axes_of(matrix);
  node.erase("matrix");
  node["translation"] = {matrix[12], matrix[13], matrix[14]};
  node["rotation"] = rotation_of(parts);
  node["scale"] = parts.lengths;
}

}  // namespace mien::app
