// Unpredictable names of temporary files.
#pragma once

#include <string>

namespace mien::app {

// ".partial-", 80 random bits, and `ending` unless that is too long for one.
[[nodiscard]] std::string partial_name(const std::string& ending);

}  // namespace mien::app
