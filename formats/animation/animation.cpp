#include "formats/animation/animation.h"

#include <algorithm>

#include "formats/animation/bvh.h"
#include "formats/animation/csv_table.h"
#include "formats/animation/curves_csv.h"
#include "formats/animation/frames_jsonl.h"
#include "formats/animation/gltf.h"
#include "formats/animation/numbers.h"
#include "formats/animation/rhubarb.h"

namespace mien::formats {
namespace {

// Editors put a byte order mark before text that has none to tell.
std::string_view without_mark(std::string_view bytes) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  return bytes.starts_with(kByteOrderMark) ? bytes.substr(kByteOrderMark.size()) : bytes;
}

// Of the first line of a table.
AnimationFormat table_kind(std::string_view text) {
  CsvTable table(text);
  Fault ignored;
  if (!table.next_row(ignored)) {
    return AnimationFormat::kCsv;
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::string_view cell = trimmed(table.cell(i));
    if (same_name(cell, "Timecode")) {
      return AnimationFormat::kLiveLink;
    }
    if (same_name(cell, "JawDrop")) {
      return AnimationFormat::kRoblox;
    }
    if (same_name(cell, "sil")) {
      return AnimationFormat::kVisemes;
    }
  }
  return AnimationFormat::kCsv;
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
    if (same_name(known.name, name)) {
      return known.format;
    }
  }
  return std::nullopt;
}

std::optional<AnimationFormat> format_by_ending(std::string_view path) {
  const FormatName* best = nullptr;
  for (const FormatName& known : kFormatNames) {
    const bool fits = path.size() > known.ending.size() &&
                      same_name(path.substr(path.size() - known.ending.size()), known.ending);
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
  bytes = without_mark(bytes);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  const std::string_view text =
      first == std::string_view::npos ? std::string_view() : bytes.substr(first);
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
  const std::string_view line = text.substr(0, text.find('\n'));
  return line.find('\t') != line.npos && line.find(',') == line.npos ? AnimationFormat::kRhubarb
                                                                     : table_kind(bytes);
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
      return bvh_writer();
    case AnimationFormat::kRoblox:
      return curves_csv_writer(options.roblox_level_1 ? Weights::kFacsLevel1 : Weights::kFacs,
                               options.several_faces);
    case AnimationFormat::kVisemes:
      return curves_csv_writer(Weights::kVisemes, options.several_faces);
    case AnimationFormat::kRhubarb:
      return rhubarb_writer(RhubarbForm::kTsv, options.sound_file);
    case AnimationFormat::kRhubarbJson:
      return rhubarb_writer(RhubarbForm::kJson, options.sound_file);
    case AnimationFormat::kRhubarbXml:
      return rhubarb_writer(RhubarbForm::kXml, options.sound_file);
    case AnimationFormat::kRhubarbDat:
      return rhubarb_writer(RhubarbForm::kDat, options.sound_file);
  }
  return nullptr;
}

bool read_animation(AnimationFormat format, std::string_view bytes,
                    const LiveLinkOptions& live_link, Clip& clip, Fault& fault) {
  bytes = without_mark(bytes);
  switch (format) {
    case AnimationFormat::kCsv:
    case AnimationFormat::kRoblox:
    case AnimationFormat::kVisemes:
      return read_curves_csv(bytes, clip, fault);
    case AnimationFormat::kJsonl:
      return read_frames_jsonl(bytes, clip, fault);
    case AnimationFormat::kLiveLink:
      return read_live_link_csv(bytes, live_link, clip, fault);
    case AnimationFormat::kGltf:
    case AnimationFormat::kGlb:
      return read_gltf(bytes, clip, fault);
    case AnimationFormat::kBvh:
      return read_bvh(bytes, clip, fault);
    case AnimationFormat::kRhubarb:
    case AnimationFormat::kRhubarbJson:
    case AnimationFormat::kRhubarbXml:
    case AnimationFormat::kRhubarbDat:
      return read_rhubarb(bytes, clip, fault);
  }
  return false;
}

}  // namespace mien::formats
