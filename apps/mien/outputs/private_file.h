// Files with a secret in one line, which only their owner can read.
#pragma once

#include <optional>
#include <string>

namespace mien::app {

// The first line, at most 256 bytes of it; nothing if the file does not exist.
[[nodiscard]] std::optional<std::string> private_line(const std::string& path);

// Creates or replaces the file. Throws Failure(kExitOutput) with the prefix `what`.
void write_private_line(const std::string& path, const std::string& line, const std::string& what);

}  // namespace mien::app
