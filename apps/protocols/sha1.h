// SHA-1 (FIPS 180-4), for the handshake of WebSocket, which needs no security from it.
#pragma once

#include <string>
#include <string_view>

namespace mien::protocols {

// 20 bytes.
[[nodiscard]] std::string sha1(std::string_view bytes);

}  // namespace mien::protocols
