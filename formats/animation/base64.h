// Base64 (RFC 4648), as data: URIs have it.
#pragma once

#include <string>
#include <string_view>

namespace mien::formats {

[[nodiscard]] std::string base64(std::string_view bytes);

// False, and `bytes` as it was, for what is no base64 with its padding.
[[nodiscard]] bool parse_base64(std::string_view text, std::string& bytes);

}  // namespace mien::formats
