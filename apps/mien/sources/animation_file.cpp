#include "apps/mien/sources/animation_file.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"

namespace mien::app {

std::string read_whole(const std::string& path) {
  if (path == "-") {
    return {std::istreambuf_iterator<char>(std::cin), {}};
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
  return {std::istreambuf_iterator<char>(file), {}};
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
