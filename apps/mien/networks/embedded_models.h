// The weight files inside the program: all of models/ with MIEN_EMBED_MODELS, else none.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace mien::app {

struct EmbeddedModel {
  std::string_view file;  // such as basenet.mien
  std::span<const std::byte> bytes;
};

// Sorted by name.
std::span<const EmbeddedModel> embedded_models();

// The folder that they appear to be in.
inline constexpr std::string_view kEmbeddedFolder = "embedded-models:";

}  // namespace mien::app
