// Selects readers and writers by format, and detects formats.
#include "apps/animation/animation.h"

#include <algorithm>

#include "apps/animation/bvh.h"
#include "apps/animation/csv_table.h"
#include "apps/animation/curves_csv.h"
#include "apps/animation/frames_jsonl.h"
#include "apps/animation/gltf.h"
#include "apps/animation/live_link_reader.h"
#include "apps/animation/numbers.h"
#include "apps/animation/rhubarb.h"
#include "apps/animation/text_encoding.h"

namespace mien::animation {
namespace {

// Detects the kind of table from its first line.
AnimationFormat table_kind(std::string_view text) {
  CsvTable table(text);
  Fault ignored;
  if (!table.next_row(ignored)) {
    return AnimationFormat::kCsv;
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::string_view cell = trimmed(table.cell(i));
    if (formats::same_name(cell, "Timecode")) {
      return AnimationFormat::kLiveLink;
    }
    if (formats::same_name(cell, "JawDrop")) {
      return AnimationFormat::kRoblox;
    }
    if (formats::same_name(cell, "sil")) {
      return AnimationFormat::kVisemes;
    }
  }
  return AnimationFormat::kCsv;
}

// A time and a mouth shape, unlike the header of a table separated by tabs.
bool is_cue(std::string_view line) {
  const std::size_t tab = line.find('\t');
  double time_s = 0.0;
  return tab != line.npos && parse_number(line.substr(0, tab), time_s);
}

AnimationFormat object_kind(std::string_view text) {
  if (text.substr(0, text.find('\n')).find("\"t_ns\"") != std::string_view::npos) {
    return AnimationFormat::kJsonl;
  }
  const bool cues = text.find("\"mouthCues\"") != std::string_view::npos;
  const bool asset = text.find("\"asset\"") != std::string_view::npos;
  return cues    ? AnimationFormat::kRhubarbJson
         : asset ? AnimationFormat::kGltf
                 : AnimationFormat::kJsonl;
}

}  // namespace

std::string_view name(AnimationFormat format) {
  for (const FormatName& known : kFormatNames) {
    if (known.format == format) {
      return known.name;
    }
  }
  return {};
}

std::optional<AnimationFormat> format_named(std::string_view name) {
  for (const FormatName& known : kFormatNames) {
    if (formats::same_name(known.name, name)) {
      return known.format;
    }
  }
  return std::nullopt;
}

std::optional<AnimationFormat> format_by_ending(std::string_view path) {
  const FormatName* best = nullptr;
  for (const FormatName& known : kFormatNames) {
    const bool fits =
        path.size() > known.ending.size() &&
        formats::same_name(path.substr(path.size() - known.ending.size()), known.ending);
    if (fits && (best == nullptr || known.ending.size() > best->ending.size())) {
      best = &known;
    }
  }
  return best != nullptr ? std::optional(best->format) : std::nullopt;
}

AnimationFormat format_by_content(std::string_view bytes) {
  if (bytes.starts_with("glTF")) {
    return AnimationFormat::kGlb;
  }
  std::string converted;
  std::string_view table;
  Fault ignored;
  if (!to_utf8(bytes, converted, table, ignored)) {
    return AnimationFormat::kCsv;
  }
  const std::string_view text =
      table.substr(std::min(table.find_first_not_of(" \t\r\n"), table.size()));
  if (text.starts_with('{')) {
    return object_kind(text);
  }
  if (text.starts_with('<')) {
    return AnimationFormat::kRhubarbXml;
  }
  if (text.starts_with("MohoSwitch1")) {
    return AnimationFormat::kRhubarbDat;
  }
  if (text.starts_with("HIERARCHY")) {
    return AnimationFormat::kBvh;
  }
  return is_cue(text.substr(0, text.find('\n'))) ? AnimationFormat::kRhubarb : table_kind(table);
}

bool holds_several_faces(AnimationFormat format) {
  return format == AnimationFormat::kCsv || format == AnimationFormat::kJsonl ||
         format == AnimationFormat::kRoblox || format == AnimationFormat::kVisemes;
}

std::unique_ptr<AnimationWriter> animation_writer(AnimationFormat format,
                                                  const WriteOptions& options) {
  switch (format) {
    case AnimationFormat::kCsv:
      return curves_csv_writer(Weights::kControls, options.several_faces);
    case AnimationFormat::kJsonl:
      return frames_jsonl_writer();
    case AnimationFormat::kLiveLink:
      return live_link_csv_writer(options.live_link);
    case AnimationFormat::kGltf:
      return gltf_writer(GltfForm::kText);
    case AnimationFormat::kGlb:
      return gltf_writer(GltfForm::kBinary);
    case AnimationFormat::kBvh:
      return bvh_writer(options.bvh_unit);
    case AnimationFormat::kRoblox:
      return curves_csv_writer(options.roblox_level_1 ? Weights::kFacsLevel1 : Weights::kFacs,
                               options.several_faces);
    case AnimationFormat::kVisemes:
      return curves_csv_writer(Weights::kVisemes, options.several_faces);
    case AnimationFormat::kRhubarb:
      return rhubarb_writer(RhubarbForm::kTsv, options.audio_file);
    case AnimationFormat::kRhubarbJson:
      return rhubarb_writer(RhubarbForm::kJson, options.audio_file);
    case AnimationFormat::kRhubarbXml:
      return rhubarb_writer(RhubarbForm::kXml, options.audio_file);
    case AnimationFormat::kRhubarbDat:
      return rhubarb_writer(RhubarbForm::kDat, options.audio_file);
  }
  return nullptr;
}

bool read_animation(AnimationFormat format, std::string_view bytes, const ReadOptions& options,
                    Clip& clip, Fault& fault) {
  std::string converted;
  std::string_view text = bytes;
  const bool binary = bytes.starts_with("glTF");
  if (!binary && !to_utf8(bytes, converted, text, fault)) {
    return false;
  }
  switch (format) {
    case AnimationFormat::kCsv:
    case AnimationFormat::kRoblox:
    case AnimationFormat::kVisemes:
      return read_curves_csv(text, clip, fault);
    case AnimationFormat::kJsonl:
      return read_frames_jsonl(text, clip, fault);
    case AnimationFormat::kLiveLink:
      return read_live_link_csv(text, options, clip, fault);
    case AnimationFormat::kGltf:
    case AnimationFormat::kGlb:
      return read_gltf(text, options, clip, fault);
    case AnimationFormat::kBvh:
      return read_bvh(text, options, clip, fault);
    case AnimationFormat::kRhubarb:
    case AnimationFormat::kRhubarbJson:
    case AnimationFormat::kRhubarbXml:
    case AnimationFormat::kRhubarbDat:
      return read_rhubarb(text, clip, fault);
  }
  return false;
}

}  // namespace mien::animation
