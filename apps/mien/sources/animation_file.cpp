#include "apps/mien/sources/animation_file.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <istream>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"

namespace mien::app {
namespace {

std::string rest_of(std::istream& stream, const std::string& name) {
  std::string text, block(std::size_t{1} << 16, '\0');
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) ||
         stream.gcount() > 0) {
    text.append(block, 0, static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) {
    throw Failure(kExitNoInput, name + ": cannot be read to its end");
  }
  return text;
}

}  // namespace

std::string read_whole(const std::string& path) {
  if (path == "-") {
    return rest_of(std::cin, "standard input");
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(path_of(path), ignored)) {
    throw Failure(kExitNoInput, path + ": is a directory");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw Failure(
        kExitNoInput,
        path + ": " +
            (std::filesystem::exists(path_of(path), ignored) ? "cannot be read" : "no such file"));
  }
  return rest_of(file, path);
}

formats::LiveLinkOptions read_live_link_notes(const std::string& path) {
  const std::string beside = path + ".json";
  std::error_code ignored;
  if (path == "-" || !std::filesystem::exists(path_of(beside), ignored)) {
    return {};
  }
  const nlohmann::json notes = nlohmann::json::parse(read_whole(beside), nullptr, false);
  if (!notes.is_object() || !notes.contains("rotation") || !notes["rotation"].is_string()) {
    return {};  // somebody else's
  }
  const std::map<std::string, formats::RotationUnit> units = {
      {"rad", formats::RotationUnit::kRadians},
      {"norm180", formats::RotationUnit::kDegreesBy180},
      {"deg", formats::RotationUnit::kDegrees}};
  const auto unit = units.find(notes["rotation"].get<std::string>());
  const nlohmann::json fps = notes.value("timecode_fps", nlohmann::json());
  if (unit == units.end() || !fps.is_number() || fps.get<double>() < 1.0 ||
      fps.get<double>() > 100.0) {
    throw Failure(kExitNoInput, beside + ": is damaged");
  }
  return {unit->second, fps.get<double>()};
}

formats::Clip parse_animation(std::string_view bytes, const std::string& name,
                              std::optional<formats::AnimationFormat> format,
                              const formats::LiveLinkOptions& live_link) {
  formats::Clip clip;
  formats::Fault fault;
  const formats::AnimationFormat kind = format.value_or(formats::format_by_content(bytes));
  if (!formats::read_animation(kind, bytes, live_link, clip, fault)) {
    throw Failure(kExitNoInput, name + ": " + formats::describe(fault));
  }
  return clip;
}

}  // namespace mien::app
