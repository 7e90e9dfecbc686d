// Strings in JSON text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mien::animation {

// The length of the valid string at the start of the text, including quotation marks.
[[nodiscard]] std::size_t json_string_bytes(std::string_view text);

// The string without its quotation marks.
[[nodiscard]] constexpr std::string_view json_inside(std::string_view string) {
  return string.substr(1, string.size() - 2);
}

// Decodes valid escapes.
[[nodiscard]] std::string json_unescaped(std::string_view inside);

// The length of the escape at the start of the text, without its '\'. Returns 0 and the reason if
// it is invalid.
[[nodiscard]] std::size_t json_escape_bytes(std::string_view text, const char*& wrong);

}  // namespace mien::animation
