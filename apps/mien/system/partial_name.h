// Unpredictable names of temporary files.
#pragma once

#include <string>

namespace mien::app {

// Returns ".partial-", 80 random bits, and `ending` unless it is too long for a file ending.
[[nodiscard]] std::string partial_name(const std::string& ending);

}  // namespace mien::app
