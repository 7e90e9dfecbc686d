// Finds weight files beside the program or the source tree, and reads them.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <mien/mien.hpp>
#include <span>
#include <string>
#include <vector>

#include "apps/mien/system/exit_codes.h"

namespace mien::app {

// A file in memory, aligned as the library requires.
class Blob {
 public:
  // Throws Failure with `code` if the file cannot be read.
  explicit Blob(const std::string& path, ExitCode code = kExitModel);
  // The weight file in a packed one. Throws Failure if it is malformed.
  static Blob unpacked(const Blob& packed);
  const void* data() const { return words_.data(); }
  std::size_t size() const { return size_; }
  std::span<const std::byte> bytes() const {
    return {static_cast<const std::byte*>(data()), size_};
  }

 private:
  Blob() = default;

  struct alignas(64) Line {
    std::byte bytes[64];
  };
  void allocate(std::size_t bytes);

  std::vector<Line> words_;
  std::size_t size_ = 0;
};

// Opened weight files.
class OpenedWeights {
 public:
  // Throws a Failure that names the file if one cannot be read or is malformed.
  explicit OpenedWeights(std::vector<std::string> paths);

  [[nodiscard]] const Weights& weights() const { return weights_; }
  [[nodiscard]] std::size_t bytes() const;
  // The path of the file that an error concerns, or of the first.
  [[nodiscard]] const std::string& path_of(const mien_error_detail& error) const;

 private:
  std::vector<std::string> paths_;
  std::deque<Blob> blobs_;  // used in place
  Weights weights_;
};

// `chosen` if not empty; else $MIEN_MODELS; else `models` beside the program, above it, or
// installed; else kEmbeddedFolder, if the program has weights inside.
std::string models_directory(const std::string& chosen);

// Whether there is a file or an embedded file at the path.
bool model_exists(const std::string& path);

// All weight files of a folder, sorted by name. Throws Failure(kExitModel) if the folder has none.
std::vector<std::filesystem::path> weight_files(const std::string& folder);

}  // namespace mien::app
