// The weight files beside the program or the source tree.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/mien/system/exit_codes.h"

namespace mien::app {

// A whole file in memory, aligned as the library asks for.
class Blob {
 public:
  // Throws Failure with the code when there is no such file.
  explicit Blob(const std::string& path, ExitCode code = kExitModel);
  const void* data() const { return words_.data(); }
  std::size_t size() const { return size_; }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::vector<Line> words_;
  std::size_t size_ = 0;
};

// `chosen` if given; else $MIEN_MODELS; else `models` beside the program, above it, or installed.
std::string models_directory(const std::string& chosen);

// All weight files of a folder, by name. Throws Failure(kExitModel) if there is none.
std::vector<std::filesystem::path> weight_files(const std::string& folder);

}  // namespace mien::app
