// What formats have no place for.
#include <algorithm>
#include <cmath>
#include <functional>

#include "formats/animation/animation.h"
#include "formats/animation/facs_map.h"
#include "formats/animation/rotation.h"

namespace mien::formats {
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
  return driven(a) != driven(b) || std::abs(a - b) > kSame;
}

bool differ(const Angles& a, const Angles& b) {
  return differ(a.pitch, b.pitch) || differ(a.yaw, b.yaw) || differ(a.roll, b.roll);
}

// Eyes that look elsewhere than the controls say.
bool has_eyes_of_its_own(const Frame& frame) {
  const auto looked = gaze(frame.controls);
  const std::array<Angles, 2> derived = looked.value_or(std::array<Angles, 2>());
  return frame.eyes &&
         (differ((*frame.eyes)[0], derived[0]) || differ((*frame.eyes)[1], derived[1]));
}

bool shows_a_control(const Frame& frame) {
  return std::any_of(frame.controls.begin(), frame.controls.end(),
                     [](double value) { return or_zero(value) != 0.0; });
}

// What of the controls does not come back from Roblox's units.
std::string lost_to_roblox(const std::vector<Frame>& frames) {
  std::string names;
  std::array<bool, kControlCount> lost{};
  for (const Frame& frame : frames) {
    if (frame.facs.empty()) {
      const auto facs = facs_of(frame.controls);
      const auto back = controls_of_facs(facs);
      for (std::size_t i = 0; i < kControlCount; ++i) {
        lost[i] =
            lost[i] || (or_zero(frame.controls[i]) != 0.0 && differ(frame.controls[i], back[i]));
      }
    }
  }
  for (std::size_t i = 0; i < kControlCount; ++i) {
    if (lost[i]) {
      names.append(names.empty() ? "" : ", ").append(kArkitNames[i]);
    }
  }
  return names;
}

struct Check {
  bool held;         // by the format
  const char* what;  // is lost
  std::function<bool(const Frame&)> there;
};

}  // namespace

std::vector<std::string> losses(const Clip& clip, AnimationFormat format) {
  if (format == Format::kJsonl) {
    return {};
  }
  const bool table = is_table(format), gltf = is_gltf(format), cues = is_cues(format);
  const bool weights = !cues && format != Format::kBvh;
  const Check checks[] = {
      {table, "face probability, voice activity, level of detail, box",
       [](const Frame& frame) {
         return driven(frame.face_probability) || driven(frame.voice_activity) || frame.lod != 0 ||
                frame.box;
       }},
      {table || gltf, "the state of tracking",
       [](const Frame& frame) { return frame.state == FaceState::kLost; }},
      {!cues, "the turn of the head", [](const Frame& frame) { return frame.head.has_value(); }},
      {!cues && format != Format::kLiveLink, "the place of the head",
       [](const Frame& frame) { return frame.position_m.has_value(); }},
      {gltf || format == Format::kLiveLink, "how the eyes are turned", has_eyes_of_its_own},
      {weights, "the controls", shows_a_control},
      {format != Format::kVisemes, "all but the mouth", shows_a_control},
      {format == Format::kRoblox, "Roblox's units, but as controls",
       [](const Frame& frame) { return !frame.facs.empty(); }},
      {format == Format::kVisemes || cues, "visemes, but as controls",
       [](const Frame& frame) { return !frame.visemes.empty(); }},
      {!cues, "times before 0: the first cue is at 0",
       [](const Frame& frame) { return frame.time_ns < 0; }},
      {cues, "mouth shapes, but as controls",
       [](const Frame& frame) { return frame.mouth_shape != 0; }},
  };
  std::vector<std::string> lost;
  for (const Check& check : checks) {
    const auto& frames = clip.frames;
    if (!check.held && std::any_of(frames.begin(), frames.end(), check.there)) {
      lost.emplace_back(check.what);
    }
  }
  if (format == Format::kRoblox) {
    const std::string names = lost_to_roblox(clip.frames);
    if (!names.empty()) {
      lost.push_back("parts of " + names);
    }
  }
  if (format == Format::kLiveLink) {
    const bool gaps = std::any_of(clip.frames.begin(), clip.frames.end(), [](const Frame& frame) {
      return shows_a_control(frame) &&
             !std::all_of(frame.controls.begin(), frame.controls.end(), driven);
    });
    if (gaps) {
      lost.emplace_back("which controls nothing drives: they become 0");
    }
  }
  if (format == Format::kBvh && !evenly_spaced(clip.frames)) {
    lost.emplace_back("the frames' own times: they become even");
  }
  return lost;
}

}  // namespace mien::formats
