// Matches names with glob patterns.
#pragma once

#include <string_view>

namespace mien::conformance {

// `*` matches any characters, `?` exactly one.
[[nodiscard]] bool matches(std::string_view glob, std::string_view name);

}  // namespace mien::conformance
