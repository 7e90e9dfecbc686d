// Converts text from any Unicode encoding to UTF-8.
#pragma once

#include <string>
#include <string_view>

#include "apps/animation/fault.h"

namespace mien::animation {

// Accepts UTF-8 with or without a byte order mark, and UTF-16 with one, or without if the first two
// characters are ASCII. `text` refers to `bytes`, or to `converted` after a conversion. Returns
// false with a fault for invalid UTF-16.
[[nodiscard]] bool to_utf8(std::string_view bytes, std::string& converted, std::string_view& text,
                           Fault& fault);

void append_utf8(char32_t code, std::string& text);

}  // namespace mien::animation
