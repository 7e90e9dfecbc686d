// The folder for settings on POSIX systems.
#include "apps/mien/system/config_folder.h"

#include <cstdlib>

namespace mien::app {
namespace {

// Relative paths are ignored, as the XDG base directory specification requires.
std::filesystem::path absolute_path(const char* variable) {
  const char* value = std::getenv(variable);
  const std::filesystem::path path = value == nullptr ? "" : value;
  return path.is_absolute() ? path : std::filesystem::path();
}

}  // namespace

std::filesystem::path config_folder() {
  const std::filesystem::path home = absolute_path("HOME");
#ifdef __APPLE__
  return home.empty() ? home : home / "Library" / "Application Support" / "mien";
#else
  const std::filesystem::path config = absolute_path("XDG_CONFIG_HOME");
  return !config.empty() ? config / "mien" : home.empty() ? home : home / ".config" / "mien";
#endif
}

}  // namespace mien::app
