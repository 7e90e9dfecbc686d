// Names by pattern.
#pragma once

#include <string_view>

namespace mien::conformance {

// `*` stands for any characters, `?` for one.
[[nodiscard]] bool matches(std::string_view glob, std::string_view name);

}  // namespace mien::conformance
