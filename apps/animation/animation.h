// All formats of facial animation: their names, readers, writers, and the data that each omits.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/animation/clip.h"
#include "apps/animation/fault.h"
#include "apps/animation/live_link_csv.h"
#include "apps/animation/read_options.h"
#include "apps/animation/writer.h"

namespace mien::animation {

enum class AnimationFormat : std::uint8_t {
  kCsv,
  kJsonl,
  kLiveLink,
  kGltf,
  kGlb,
  kBvh,
  kRoblox,
  kVisemes,
  kRhubarb,
  kRhubarbJson,
  kRhubarbXml,
  kRhubarbDat
};

struct FormatName {
  AnimationFormat format;
  std::string_view name;    // for options
  std::string_view ending;  // unique ending of file names
  std::string_view holds;   // one line for help texts
};

inline constexpr std::array<FormatName, 12> kFormatNames = {{
    {AnimationFormat::kCsv, "csv", ".csv", "curves of the 52 ARKit controls"},
    {AnimationFormat::kJsonl, "jsonl", ".jsonl", "all data, one object per frame"},
    {AnimationFormat::kLiveLink, "llf", ".llf.csv", "CSV as Live Link Face records it"},
    {AnimationFormat::kGltf, "gltf", ".gltf", "glTF: morph weights, head, eyes; as text"},
    {AnimationFormat::kGlb, "glb", ".glb", "the same in one binary file"},
    {AnimationFormat::kBvh, "bvh", ".bvh", "head motion"},
    {AnimationFormat::kRoblox, "roblox", ".roblox.csv", "curves of Roblox's 50 units"},
    {AnimationFormat::kVisemes, "visemes", ".visemes.csv", "curves of 15 visemes (OVR, OpenXR)"},
    {AnimationFormat::kRhubarb, "rhubarb", ".tsv", "mouth cues of Rhubarb Lip Sync"},
    {AnimationFormat::kRhubarbJson, "rhubarb-json", ".rhubarb.json", "the same as JSON"},
    {AnimationFormat::kRhubarbXml, "rhubarb-xml", ".xml", "the same as XML"},
    {AnimationFormat::kRhubarbDat, "rhubarb-dat", ".dat", "the same for Moho and OpenToonz"},
}};

[[nodiscard]] std::string_view name(AnimationFormat format);
[[nodiscard]] std::optional<AnimationFormat> format_named(std::string_view name);

// The format of the longest matching ending of a file name, if any.
[[nodiscard]] std::optional<AnimationFormat> format_by_ending(std::string_view path);

// Detects the format from the content.
[[nodiscard]] AnimationFormat format_by_content(std::string_view bytes);

// Whether the format distinguishes several faces.
[[nodiscard]] bool holds_several_faces(AnimationFormat format);

struct WriteOptions {
  LiveLinkOptions live_link;
  LengthUnit bvh_unit = LengthUnit::kMetres;
  bool roblox_level_1 = false;  // 6 units instead of 50
  bool several_faces = false;   // csv, roblox, visemes: write the column face_id
  std::string audio_file;       // name for rhubarb-json and rhubarb-xml
};

[[nodiscard]] std::unique_ptr<AnimationWriter> animation_writer(AnimationFormat format,
                                                                const WriteOptions& options);

// Leaves `clip` unchanged on failure. Text may be UTF-8 or UTF-16, with or without a byte order
// mark.
[[nodiscard]] bool read_animation(AnimationFormat format, std::string_view bytes,
                                  const ReadOptions& options, Clip& clip, Fault& fault);

struct LossCheck {
  bool held;         // the format stores it
  const char* what;  // description of the data
  bool (*there)(const Frame& frame);
};

// Determines which data of a clip a format omits. Precision does not count: docs/cli.md states it
// for each format.
class Losses {
 public:
  explicit Losses(AnimationFormat format);

  void add(const Frame& frame);
  // `evenly_spaced`: whether the times of the frames are.
  [[nodiscard]] std::vector<std::string> found(bool evenly_spaced) const;

 private:
  AnimationFormat format_;
  std::vector<LossCheck> checks_;
  std::vector<bool> there_;  // per check
  std::array<bool, formats::kControlCount>
      changed_{};      // controls that Roblox's units do not preserve
  bool gaps_ = false;  // some controls are unsupported
};

[[nodiscard]] std::vector<std::string> losses(const Clip& clip, AnimationFormat format);

}  // namespace mien::animation
