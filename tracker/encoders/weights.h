// The type behind the C API's mien_weights: validated weight files in memory.
#pragma once

#include <mien/mien.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "engine/model.h"

struct mien_weights {
  static constexpr std::size_t kMaxModels = 16;

  struct File {
    mien::engine::Model model;
    std::int32_t index = -1;   // in mien_weights_config.files
    std::uint64_t offset = 0;  // in that file, bytes
  };

  [[nodiscard]] const File* begin() const { return files.data(); }
  [[nodiscard]] const File* end() const { return files.data() + count; }

  mutable std::atomic<std::uint32_t> references{1};  // of the caller, trackers and networks
  mien_allocator allocator = {};
  std::size_t count = 0;
  std::array<File, kMaxModels> files;
};
