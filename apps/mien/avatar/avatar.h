// Bakes animations into avatars of users: .glb and .vrm files with morph targets.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "apps/animation/writer.h"
#include "apps/mien/avatar/drivers.h"
#include "apps/mien/avatar/glb.h"
#include "apps/mien/avatar/rig.h"

namespace mien::app {

// A term of a morph target's weight.
struct MorphTerm {
  std::size_t target = 0;
  Driver driver;
  double weight = 1.0;
};

// A node whose mesh has driven morph targets.
struct MorphNode {
  std::size_t node = 0;
  std::vector<float> rest;  // weights of all targets without animation
  std::vector<MorphTerm> terms;
};

class Avatar {
 public:
  // Throws Failure(kExitNoInput) if the file is not a valid avatar, or if it has neither morph
  // targets with known names nor a head bone.
  explicit Avatar(const std::string& file);

  // The avatar with an animation `mien` of its morph targets, head and eyes, before its own
  // animations. The rest of the file stays as it is.
  [[nodiscard]] std::string animated(const animation::FrameSequence& frames) const;

 private:
  Glb glb_;
  std::vector<MorphNode> morphs_;
  Rig rig_;
};

// Writes a .glb.
[[nodiscard]] std::unique_ptr<animation::AnimationWriter> avatar_writer(const std::string& file);

}  // namespace mien::app
