// Where this program itself lies; posix/ and win32/ have one each.
#pragma once

#include <filesystem>

namespace mien::app {

// Empty where that is not known.
std::filesystem::path program_path();

}  // namespace mien::app
