// Validates names and texts of weight files.
#pragma once

#include <string_view>

namespace mien::formats {

// One or more of a-z 0-9 _ . /
[[nodiscard]] bool is_name(std::string_view text);

// UTF-8 (RFC 3629) without control characters (U+0000 to U+001F, U+007F to U+009F) except tab and
// line feed.
[[nodiscard]] bool is_text(std::string_view text);

}  // namespace mien::formats
