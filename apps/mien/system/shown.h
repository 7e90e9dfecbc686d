// Text of others (names of files, URLs, what ffmpeg said) as it may be printed.
#pragma once

#include <string>
#include <string_view>

namespace mien::app {

// User names and passwords of URLs, and values of their parameters that look like secrets, become
// "***".
[[nodiscard]] std::string without_credentials(std::string_view text);

// Without credentials, and in one line that a terminal only shows: control characters, those that
// turn the direction of writing, and what is no UTF-8 become "\x1b" or "\u202e".
[[nodiscard]] std::string shown(std::string_view text);
// The same of a text that has lines of its own.
[[nodiscard]] std::string shown_lines(std::string_view text);

}  // namespace mien::app
