// The user's folder for settings of this program. posix/ and win32/ have one implementation each.
#pragma once

#include <filesystem>

namespace mien::app {

// $XDG_CONFIG_HOME/mien or ~/.config/mien, on macOS ~/Library/Application Support/mien, on Windows
// %APPDATA%\mien. Need not exist; empty if it is unknown.
[[nodiscard]] std::filesystem::path config_folder();

}  // namespace mien::app
