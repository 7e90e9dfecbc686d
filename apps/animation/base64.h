// Base64 (RFC 4648), as in data: URIs.
#pragma once

#include <string>
#include <string_view>

namespace mien::animation {

[[nodiscard]] std::string base64(std::string_view bytes);

// Returns false and leaves `bytes` unchanged if `text` is not padded base64.
[[nodiscard]] bool parse_base64(std::string_view text, std::string& bytes);

}  // namespace mien::animation
