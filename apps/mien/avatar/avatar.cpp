// Bakes animations into avatars.
#include "apps/mien/avatar/avatar.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "apps/animation/gltf_keys.h"
#include "apps/mien/avatar/morphs.h"
#include "apps/mien/sources/animation_file.h"
#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

using animation::Angles;
using animation::Frame;
using animation::FrameSequence;

// Keys of a node's property.
struct Keys {
  std::vector<float> times_s, values;
};

// Rotations of a bone.
class BoneKeys {
 public:
  explicit BoneKeys(const std::optional<Bone>& bone) : bone_(bone) {}

  void add(const Rig& rig, float second, const Angles& angles) {
    if (!bone_) {
      return;
    }
    keys.times_s.push_back(second);
    for (const double part : rotations_.next(bone_->turned(rig.in_scene(angles)))) {
      keys.values.push_back(static_cast<float>(part));
    }
  }
  [[nodiscard]] std::size_t node() const { return bone_->node; }

  Keys keys;

 private:
  std::optional<Bone> bone_;
  animation::KeyRotations rotations_;
};

std::vector<float> weights(const MorphNode& morphs, const DriverValues& values) {
  std::vector<double> sums(morphs.rest.begin(), morphs.rest.end());
  for (const MorphTerm& term : morphs.terms) {
    sums[term.target] = 0.0;
  }
  for (const MorphTerm& term : morphs.terms) {
    sums[term.target] += term.weight * values.of(term.driver);
  }
  std::vector<float> result;
  result.reserve(sums.size());
  for (const double sum : sums) {
    result.push_back(static_cast<float>(std::clamp(sum, 0.0, 1.0)));
  }
  return result;
}

// The animation `mien`, whose channels are added to a document.
class AnimationBuilder {
 public:
  AnimationBuilder(Glb& glb, bool holds) : glb_(glb), interpolation_(holds ? "STEP" : "LINEAR") {}

  void add(std::size_t node, const char* path, const Keys& keys, std::size_t width) {
    if (keys.times_s.empty()) {
      return;
    }
    split_matrix(glb_.document["nodes"][node]);
    const std::size_t input = add_floats(glb_, keys.times_s, 1);
    const std::size_t output = add_floats(glb_, keys.values, width);
    samplers_.push_back({{"input", input}, {"output", output}, {"interpolation", interpolation_}});
    channels_.push_back(
        {{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }

  void finish() {
    if (channels_.empty()) {
      return;
    }
    Json all = Json::array({{{"name", "mien"}, {"channels", channels_}, {"samplers", samplers_}}});
    for (const Json& own : glb_.document.value("animations", Json::array())) {
      all.push_back(own);
    }
    glb_.document["animations"] = std::move(all);
  }

 private:
  Glb& glb_;
  const char* interpolation_;
  Json channels_ = Json::array(), samplers_ = Json::array();
};

// Whether morph targets move the gaze. Eye bones must then stay still: both together would double
// the angle.
bool looks_by_morphs(const std::vector<MorphNode>& nodes) {
  Frame looking;
  looking.controls.fill(0.0);
  looking.controls[formats::control("eyeLookInLeft")] = 1.0;
  const DriverValues values(looking);
  return std::any_of(nodes.begin(), nodes.end(), [&](const MorphNode& morphs) {
    return std::any_of(morphs.terms.begin(), morphs.terms.end(),
                       [&](const MorphTerm& term) { return values.of(term.driver) > 0.0; });
  });
}

class AvatarWriter : public animation::WholeClipWriter {
 public:
  explicit AvatarWriter(const std::string& file) : avatar_(file) {}

 protected:
  std::string whole(const FrameSequence& frames) override { return avatar_.animated(frames); }

 private:
  Avatar avatar_;
};

}  // namespace

Avatar::Avatar(const std::string& file) : glb_(read_glb(read_whole(file), file)) {
  try {
    morphs_ = find_morphs(glb_.document);
    rig_ = find_rig(glb_.document);
  } catch (const std::exception& error) {  // of Json, or an index out of range
    throw Failure(kExitNoInput, file + ": invalid glTF: " + error.what());
  }
  if (morphs_.empty() && !rig_.head) {
    throw Failure(kExitNoInput,
                  file +
                      ": no morph target with a known name and no bone named head (expected "
                      "names of ARKit, Roblox, VRM or visemes)");
  }
  if (looks_by_morphs(morphs_)) {
    rig_.eyes = {};
  }
}

std::string Avatar::animated(const FrameSequence& frames) const {
  std::vector<Keys> morphs(morphs_.size());
  BoneKeys head(rig_.head), left(rig_.eyes[0]), right(rig_.eyes[1]);
  animation::KeyTimes times(frames);
  bool holds = true;
  for (const Frame& frame : frames) {
    const std::optional<float> key = times.next(frame);
    if (!key) {
      continue;
    }
    const float second = *key;
    holds = holds && frame.holds();
    const DriverValues values(frame);
    for (std::size_t i = 0; i < morphs_.size(); ++i) {
      const std::vector<float> added = weights(morphs_[i], values);
      morphs[i].times_s.push_back(second);
      morphs[i].values.insert(morphs[i].values.end(), added.begin(), added.end());
    }
    if (frame.head) {
      head.add(rig_, second, *frame.head);
    }
    if (const auto eyes = frame.eyes ? frame.eyes : animation::gaze(frame.controls)) {
      left.add(rig_, second, (*eyes)[0]);
      right.add(rig_, second, (*eyes)[1]);
    }
  }
  Glb glb = glb_;
  AnimationBuilder animation(glb, holds);
  for (std::size_t i = 0; i < morphs_.size(); ++i) {
    animation.add(morphs_[i].node, "weights", morphs[i], 1);
  }
  for (const BoneKeys* bone : {&head, &left, &right}) {
    if (!bone->keys.times_s.empty()) {
      animation.add(bone->node(), "rotation", bone->keys, 4);
    }
  }
  animation.finish();
  return glb_bytes(glb);
}

std::unique_ptr<animation::AnimationWriter> avatar_writer(const std::string& file) {
  return std::make_unique<AvatarWriter>(file);
}

}  // namespace mien::app
