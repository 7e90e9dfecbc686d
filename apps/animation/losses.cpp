// Determines the data that formats omit.
#include <algorithm>
#include <cmath>

#include "apps/animation/animation.h"
#include "apps/animation/facs_map.h"
#include "apps/animation/rotation.h"

namespace mien::animation {
namespace {

using Format = AnimationFormat;

bool is_table(Format format) {
  return format == Format::kCsv || format == Format::kRoblox || format == Format::kVisemes;
}

bool is_gltf(Format format) { return format == Format::kGltf || format == Format::kGlb; }

bool is_cues(Format format) {
  return format == Format::kRhubarb || format == Format::kRhubarbJson ||
         format == Format::kRhubarbXml || format == Format::kRhubarbDat;
}

bool differ(double a, double b) {
  constexpr double kSame = 1e-6;
  return formats::driven(a) != formats::driven(b) || std::abs(a - b) > kSame;
}

bool differ(const Angles& a, const Angles& b) {
  return differ(a.pitch, b.pitch) || differ(a.yaw, b.yaw) || differ(a.roll, b.roll);
}

// Eyes with rotations that differ from the controls.
bool has_own_eye_rotation(const Frame& frame) {
  const auto looked = gaze(frame.controls);
  const std::array<Angles, 2> derived = looked.value_or(std::array<Angles, 2>());
  return frame.eyes &&
         (differ((*frame.eyes)[0], derived[0]) || differ((*frame.eyes)[1], derived[1]));
}

bool has_control(const Frame& frame) {
  return std::any_of(frame.controls.begin(), frame.controls.end(),
                     [](double value) { return formats::or_zero(value) != 0.0; });
}

bool has_all_controls(const Frame& frame) {
  return std::all_of(frame.controls.begin(), frame.controls.end(), formats::driven);
}

std::vector<LossCheck> checks_of(Format format) {
  const bool table = is_table(format), gltf = is_gltf(format), cues = is_cues(format);
  const bool weights = !cues && format != Format::kBvh;
  return {
      {table, "face probability, voice activity, level of detail, box",
       [](const Frame& frame) {
         return formats::driven(frame.face_probability) || formats::driven(frame.voice_activity) ||
                frame.lod != 0 || frame.box.has_value();
       }},
      {table || gltf, "tracking state",
       [](const Frame& frame) { return frame.state == FaceState::kLost; }},
      {!cues, "head rotation", [](const Frame& frame) { return frame.head.has_value(); }},
      {!cues && format != Format::kLiveLink, "head position",
       [](const Frame& frame) { return frame.position_m.has_value(); }},
      {gltf || format == Format::kLiveLink, "eye rotation", has_own_eye_rotation},
      {weights, "the controls", has_control},
      {format != Format::kVisemes, "controls other than those of the mouth", has_control},
      {format == Format::kRoblox, "Roblox units (written as controls)",
       [](const Frame& frame) { return !frame.facs.empty(); }},
      {format == Format::kVisemes || cues, "visemes (written as controls)",
       [](const Frame& frame) { return !frame.visemes.empty(); }},
      {!cues, "times before 0 (the first cue is at 0)",
       [](const Frame& frame) { return frame.time_ns < 0; }},
      {cues, "mouth shapes (written as controls)",
       [](const Frame& frame) { return frame.mouth_shape != 0; }},
  };
}

}  // namespace

Losses::Losses(AnimationFormat format) : format_(format) {
  if (format != Format::kJsonl) {
    checks_ = checks_of(format);
  }
  there_.resize(checks_.size());
}

void Losses::add(const Frame& frame) {
  for (std::size_t i = 0; i < checks_.size(); ++i) {
    there_[i] = there_[i] || (!checks_[i].held && checks_[i].there(frame));
  }
  if (format_ == Format::kRoblox && frame.facs.empty()) {
    const auto back = controls_of_facs(facs_of(frame.controls));
    for (std::size_t i = 0; i < formats::kControlCount; ++i) {
      const double value = frame.controls[i];
      changed_[i] = changed_[i] || (formats::or_zero(value) != 0.0 && differ(value, back[i]));
    }
  }
  if (format_ == Format::kLiveLink) {
    gaps_ = gaps_ || (has_control(frame) && !has_all_controls(frame));
  }
}

std::vector<std::string> Losses::found(bool evenly_spaced) const {
  std::vector<std::string> lost;
  for (std::size_t i = 0; i < checks_.size(); ++i) {
    if (there_[i]) {
      lost.emplace_back(checks_[i].what);
    }
  }
  std::string names;
  for (std::size_t i = 0; i < formats::kControlCount; ++i) {
    if (changed_[i]) {
      names.append(names.empty() ? "" : ", ").append(formats::kArkitNames[i]);
    }
  }
  if (!names.empty()) {
    lost.push_back("parts of " + names);
  }
  if (gaps_) {
    lost.emplace_back("which controls are unsupported (they become 0)");
  }
  if (format_ == Format::kBvh && !evenly_spaced) {
    lost.emplace_back("frame times (they become even)");
  }
  return lost;
}

std::vector<std::string> losses(const Clip& clip, AnimationFormat format) {
  Losses losses(format);
  for (const Frame& frame : clip.frames) {
    losses.add(frame);
  }
  return losses.found(evenly_spaced(clip.frames));
}

}  // namespace mien::animation
