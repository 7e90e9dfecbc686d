// Selects animation formats and writes animations.
#include "apps/mien/outputs/animation_output.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "apps/mien/avatar/avatar.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"

namespace mien::app {
namespace {

using animation::AnimationFormat;
using animation::RotationUnit;

std::string format_names() {
  std::string names;
  for (const animation::FormatName& known : animation::kFormatNames) {
    names.append(names.empty() ? "" : ", ").append(known.name);
  }
  return names;
}

std::string endings() {
  std::string listed;
  for (const animation::FormatName& known : animation::kFormatNames) {
    listed.append(listed.empty() ? "" : ", ").append(known.ending);
  }
  return listed;
}

AnimationFormat format_of(const std::string& file, const char* format_option) {
  if (const auto format = animation::format_by_ending(file)) {
    return *format;
  }
  const std::string ending = name_of(path_of(file).extension());
  if (file == kStandardOutput || ending.empty()) {
    return AnimationFormat::kCsv;
  }
  throw Failure(kExitUsage, file + ": unknown format (got " + ending + ", expected one of " +
                                endings() + "; or " + format_option + " " + format_names() + ")");
}

const char* unit_name(RotationUnit unit) {
  switch (unit) {
    case RotationUnit::kRadians:
      return "rad";
    case RotationUnit::kDegreesBy180:
      return "norm180";
    case RotationUnit::kDegrees:
      return "deg";
  }
  return "";
}

std::string live_link_notes(const animation::LiveLinkOptions& options) {
  const nlohmann::ordered_json notes = {{"rotation", unit_name(options.rotation)},
                                        {"timecode_fps", options.timecode_fps}};
  return notes.dump() + "\n";
}

}  // namespace

AnimationFormat format_asked_for(const std::string& name) {
  if (const auto format = animation::format_named(name)) {
    return *format;
  }
  throw Failure(kExitUsage,
                "unknown format '" + name + "', supported formats are " + format_names());
}

std::vector<AnimationTarget> targets(const AnimationOptions& options) {
  const std::vector<std::string> files =
      options.files.empty() ? std::vector<std::string>{kStandardOutput} : options.files;
  if (!options.formats.empty() && options.formats.size() != files.size()) {
    throw Failure(kExitUsage, "--format: expected once per -o, or not at all");
  }
  std::vector<AnimationTarget> selected;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const AnimationFormat format = options.formats.empty()
                                       ? format_of(files[i], options.format_option)
                                       : format_asked_for(options.formats[i]);
    selected.push_back({files[i], format, format == AnimationFormat::kGlb ? options.avatar : ""});
    for (std::size_t k = 0; k < i; ++k) {
      if (selected[k].file == files[i]) {
        throw Failure(kExitUsage, files[i] + ": duplicate output path");
      }
    }
    if (options.writing.several_faces && !animation::holds_several_faces(selected.back().format)) {
      throw Failure(kExitUsage,
                    files[i] + ": " + std::string(animation::name(selected.back().format)) +
                        " supports a single face; track one face, or write .jsonl and convert it");
    }
  }
  const bool takes_avatar = std::any_of(
      selected.begin(), selected.end(),
      [](const AnimationTarget& target) { return target.format == AnimationFormat::kGlb; });
  if (!options.avatar.empty() && !takes_avatar && !options.avatar_in_report) {
    throw Failure(kExitUsage,
                  "--avatar: no output for it (expected a .glb file, or a report of mien track)");
  }
  return selected;
}

std::vector<std::string> files_of(const AnimationTarget& target) {
  std::vector<std::string> files = {target.file};
  if (target.file != kStandardOutput && target.format == AnimationFormat::kLiveLink) {
    files.push_back(target.file + ".json");
  }
  return files;
}

AnimationOutput::AnimationOutput(const AnimationTarget& target,
                                 const animation::WriteOptions& options)
    : writer_(target.avatar.empty() ? animation::animation_writer(target.format, options)
                                    : avatar_writer(target.avatar)) {
  const std::vector<std::string> files = files_of(target);
  if (target.file != kStandardOutput) {
    file_ = std::make_unique<OutputFile>(files.front());
  }
  if (files.size() > 1) {
    beside_ = std::make_unique<OutputFile>(files.back());
    beside_->write(live_link_notes(options.live_link));
  }
  write(writer_->begin());
}

void AnimationOutput::frame(const animation::Frame& frame) { write(writer_->frame(frame)); }

void AnimationOutput::finish() {
  write(writer_->finish());
  if (file_) {
    file_->finish();
  } else {
    write_standard_output("", wanted_);
  }
  if (beside_) {
    beside_->finish();
  }
}

void AnimationOutput::write(const std::string& text) {
  if (file_) {
    file_->write(text);
  } else if (!text.empty()) {
    write_standard_output(text, wanted_);
  }
}

}  // namespace mien::app
