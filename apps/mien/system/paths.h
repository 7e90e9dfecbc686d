// Conversions of paths. File names are UTF-8 in the whole program, but std::filesystem::path takes
// a std::string for another encoding on Windows.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mien::app {

[[nodiscard]] inline std::filesystem::path path_of(std::string_view name) {
  return std::u8string(name.begin(), name.end());
}

// With '/' between folders on every system.
[[nodiscard]] inline std::string name_of(const std::filesystem::path& path) {
  const std::u8string name = path.generic_u8string();
  return {name.begin(), name.end()};
}

}  // namespace mien::app
