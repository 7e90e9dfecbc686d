// Strings of JSON as they stand in a text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mien::formats {

// Of a good string that the text begins with, with its quotation marks.
[[nodiscard]] std::size_t json_string_bytes(std::string_view text);

// Without its quotation marks.
[[nodiscard]] constexpr std::string_view json_inside(std::string_view string) {
  return string.substr(1, string.size() - 2);
}

// What good escapes in it mean.
[[nodiscard]] std::string json_unescaped(std::string_view inside);

// How many bytes the escape takes that the text begins with, behind its '\'; 0 and what is wrong
// where it is no good one.
[[nodiscard]] std::size_t json_escape_bytes(std::string_view text, const char*& wrong);

}  // namespace mien::formats
