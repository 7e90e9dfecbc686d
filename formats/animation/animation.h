// All formats of animated faces under one roof: which there are, how they are written and read, and
// what each cannot hold.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/animation/clip.h"
#include "formats/animation/fault.h"
#include "formats/animation/live_link_csv.h"
#include "formats/animation/read_options.h"
#include "formats/animation/writer.h"

namespace mien::formats {

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
  std::string_view name;    // as people ask for it
  std::string_view ending;  // that means this one and no other
  std::string_view holds;   // a line for help texts
};

inline constexpr std::array<FormatName, 12> kFormatNames = {{
    {AnimationFormat::kCsv, "csv", ".csv", "curves of the 52 ARKit controls"},
    {AnimationFormat::kJsonl, "jsonl", ".jsonl", "everything, an object a frame"},
    {AnimationFormat::kLiveLink, "llf", ".llf.csv", "CSV as Live Link Face records it"},
    {AnimationFormat::kGltf, "gltf", ".gltf", "glTF: morph weights, head, eyes; as text"},
    {AnimationFormat::kGlb, "glb", ".glb", "the same in one binary file"},
    {AnimationFormat::kBvh, "bvh", ".bvh", "head motion"},
    {AnimationFormat::kRoblox, "roblox", ".roblox.csv", "curves of Roblox's 50 units"},
    {AnimationFormat::kVisemes, "visemes", ".visemes.csv", "curves of 15 visemes (OVR, OpenXR)"},
    {AnimationFormat::kRhubarb, "rhubarb", ".tsv", "mouth cues as Rhubarb Lip Sync has them"},
    {AnimationFormat::kRhubarbJson, "rhubarb-json", ".rhubarb.json", "the same as JSON"},
    {AnimationFormat::kRhubarbXml, "rhubarb-xml", ".xml", "the same as XML"},
    {AnimationFormat::kRhubarbDat, "rhubarb-dat", ".dat", "the same for Moho and OpenToonz"},
}};

[[nodiscard]] std::string_view name(AnimationFormat format);
[[nodiscard]] std::optional<AnimationFormat> format_named(std::string_view name);

// What a file name's ending means, the longest first; nothing where it means none of them.
[[nodiscard]] std::optional<AnimationFormat> format_by_ending(std::string_view path);

// What a file holds, as its content tells.
[[nodiscard]] AnimationFormat format_by_content(std::string_view bytes);

// Whether frames of several faces can be told apart in it.
[[nodiscard]] bool holds_several_faces(AnimationFormat format);

struct WriteOptions {
  LiveLinkOptions live_link;
  LengthUnit bvh_unit = LengthUnit::kMetres;
  bool roblox_level_1 = false;  // 6 units instead of 50
  bool several_faces = false;   // of csv, roblox, visemes: a column more
  std::string audio_file;       // to be named in rhubarb-json, -xml
};

[[nodiscard]] std::unique_ptr<AnimationWriter> animation_writer(AnimationFormat format,
                                                                const WriteOptions& options);

// On a fault `clip` stays as it was. Text may be UTF-8 or UTF-16, with or without a byte order
// mark.
[[nodiscard]] bool read_animation(AnimationFormat format, std::string_view bytes,
                                  const ReadOptions& options, Clip& clip, Fault& fault);

struct LossCheck {
  bool held;         // by the format
  const char* what;  // is lost
  bool (*there)(const Frame& frame);
};

// Finds what of a clip a format has no place for, in words; nothing where it holds all of it.
// Digits count as held: docs/cli.md says how many each format has.
class Losses {
 public:
  explicit Losses(AnimationFormat format);

  void add(const Frame& frame);
  // `evenly_spaced`: whether the frames were so.
  [[nodiscard]] std::vector<std::string> found(bool evenly_spaced) const;

 private:
  AnimationFormat format_;
  std::vector<LossCheck> checks_;
  std::vector<bool> there_;                    // of the checks
  std::array<bool, kControlCount> changed_{};  // what does not come back from Roblox's units
  bool gaps_ = false;                          // controls that nothing drives, beside others
};

[[nodiscard]] std::vector<std::string> losses(const Clip& clip, AnimationFormat format);

}  // namespace mien::formats
