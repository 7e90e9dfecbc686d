// Makes untrusted text (file names, URLs, messages of ffmpeg) safe to print.
#pragma once

#include <string>
#include <string_view>

namespace mien::app {

// Replaces user names and passwords in URLs, and parameters that look like secrets, with "***".
[[nodiscard]] std::string without_credentials(std::string_view text);

// Removes credentials and returns one line. Control characters, characters that change the text
// direction, and invalid UTF-8 become "\x1b" or "\u202e".
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace mien::app
