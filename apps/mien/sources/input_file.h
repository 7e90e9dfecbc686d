// Opens files that are read without ffmpeg, or standard input.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "apps/mien/sources/audio_source.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"

namespace mien::app {

struct CloseInput {
  void operator()(std::FILE* file) const {
    if (file != stdin) {
      std::fclose(file);
    }
  }
};
using InputFile = std::unique_ptr<std::FILE, CloseInput>;

// The name of an input in messages.
[[nodiscard]] inline std::string input_label(const std::string& name) {
  return name == kStandardInput ? "standard input" : name;
}

[[nodiscard]] inline InputFile open_input_file(const std::string& name) {
  InputFile file(name == kStandardInput ? stdin : std::fopen(name.c_str(), "rb"));
  if (!file) {
    throw Failure(kExitNoInput, input_label(name) + ": no such file");
  }
  return file;
}

// False for pipes, whose bytes can be read only once.
[[nodiscard]] inline bool can_be_read_again(const std::string& name) {
  std::error_code unknown;
  return name != kStandardInput && std::filesystem::is_regular_file(path_of(name), unknown);
}

}  // namespace mien::app
