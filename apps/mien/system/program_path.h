// The path of this program. posix/ and win32/ have one implementation each.
#pragma once

#include <filesystem>

namespace mien::app {

// Empty if unknown.
std::filesystem::path program_path();

}  // namespace mien::app
