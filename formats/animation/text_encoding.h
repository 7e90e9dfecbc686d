// Text as UTF-8, in whatever encoding of Unicode a file has it.
#pragma once

#include <string>
#include <string_view>

#include "formats/animation/fault.h"

namespace mien::formats {

// UTF-8 with or without a byte order mark; UTF-16 with one, or without where the first two
// characters are ASCII. `text` is part of `bytes`, or of `converted` where that was needed. False,
// with a fault, for what is no UTF-16.
[[nodiscard]] bool to_utf8(std::string_view bytes, std::string& converted, std::string_view& text,
                           Fault& fault);

void append_utf8(char32_t code, std::string& text);

}  // namespace mien::formats
