// Reads animation files and the Live Link Face notes beside them.
#include "apps/mien/sources/animation_file.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <istream>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/printable.h"

namespace mien::app {
namespace {

// Larger sizes reported by a file system are not reserved in advance, because they may be wrong.
constexpr std::uintmax_t kMaxReserved = std::uintmax_t{1} << 32;

// `size` is the expected number of bytes, 0 if it is unknown.
std::string rest_of(std::istream& stream, const std::string& name, std::size_t size) {
  std::string text, block(std::size_t{1} << 16, '\0');
  text.reserve(size);
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) ||
         stream.gcount() > 0) {
    text.append(block, 0, static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) {
    throw Failure(kExitNoInput, name + ": read error before the end of the file");
  }
  return text;
}

// Rejects files outside `folder` and everything that is not a regular file: the animation that
// names them may be untrusted.
bool load(const std::filesystem::path& folder, const std::string& name, std::size_t bytes,
          std::string& data, std::string& why) {
  const std::filesystem::path relative = path_of(name);
  const bool leaves = relative.is_absolute() || relative.has_root_path() ||
                      std::find(relative.begin(), relative.end(), "..") != relative.end();
  if (leaves || name.find(':') != std::string::npos) {
    why = "not in the folder of the file";
    return false;
  }
  std::error_code error;
  const std::filesystem::path whole = folder / relative;
  if (!std::filesystem::is_regular_file(whole, error)) {
    why = std::filesystem::exists(whole, error) ? "not a regular file" : "no such file";
    return false;
  }
  if (std::filesystem::file_size(whole, error) < bytes || error) {
    why = "shorter than " + std::to_string(bytes) + " bytes";
    return false;
  }
  data.resize(bytes);
  std::ifstream file(whole, std::ios::binary);
  if (!file.read(data.data(), static_cast<std::streamsize>(bytes))) {
    why = "cannot be read";
    return false;
  }
  return true;
}

// Reads units from FILE.json beside FILE, if mien wrote it.
void read_live_link_notes(const std::string& path, animation::ReadOptions& options) {
  const std::string beside = live_link_notes_of(path);
  std::error_code ignored;
  if (!std::filesystem::exists(path_of(beside), ignored)) {
    return;
  }
  const nlohmann::json notes = nlohmann::json::parse(read_whole(beside), nullptr, false);
  if (!notes.is_object() || !notes.contains("rotation") || !notes["rotation"].is_string()) {
    return;
  }
  const std::map<std::string, animation::RotationUnit> units = {
      {"rad", animation::RotationUnit::kRadians},
      {"norm180", animation::RotationUnit::kDegreesBy180},
      {"deg", animation::RotationUnit::kDegrees}};
  const auto unit = units.find(notes["rotation"].get<std::string>());
  const nlohmann::json fps = notes.value("timecode_fps", nlohmann::json());
  if (unit == units.end() || !fps.is_number() || fps.get<double>() < 1.0 ||
      fps.get<double>() > 100.0) {
    throw Failure(
        kExitNoInput,
        beside + ": damaged, expected rotation rad, norm180 or deg and timecode_fps 1 to 100");
  }
  options.rotation = unit->second;
  options.timecode_fps = fps.get<double>();
}

}  // namespace

std::string live_link_notes_of(const std::string& path) { return path + ".json"; }

std::string read_whole(const std::string& path) {
  if (path == "-") {
    return rest_of(std::cin, "standard input", 0);
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
  const std::uintmax_t size = std::filesystem::file_size(path_of(path), ignored);
  return rest_of(file, path, ignored || size > kMaxReserved ? 0 : static_cast<std::size_t>(size));
}

animation::ReadOptions read_options_for(const std::string& path) {
  animation::ReadOptions options;
  if (path == "-") {
    return options;
  }
  options.load_beside = [folder = path_of(path).parent_path()](
                            const std::string& name, std::size_t bytes, std::string& data,
                            std::string& why) { return load(folder, name, bytes, data, why); };
  read_live_link_notes(path, options);
  return options;
}

animation::Clip parse_animation(std::string_view bytes, const std::string& name,
                                std::optional<animation::AnimationFormat> format,
                                const animation::ReadOptions& options) {
  animation::Clip clip;
  animation::Fault fault;
  const animation::AnimationFormat kind = format.value_or(animation::format_by_content(bytes));
  if (!animation::read_animation(kind, bytes, options, clip, fault)) {
    throw Failure(kExitNoInput, name + ": " + animation::describe(fault));
  }
  return clip;
}

void print_notes(const std::string& name, const animation::Clip& clip) {
  for (const std::string& note : clip.notes) {
    std::fprintf(stderr, "%s: %s\n", printable(name).c_str(), printable(note).c_str());
  }
}

}  // namespace mien::app
