// iFacialMocap over UDP, port 49983, in the role of the phone (`ifacialmocap.com/for-developer`): a
// receiver that sends a hello gets a stream of text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "apps/animation/clip.h"

namespace mien::protocols {

inline constexpr std::string_view kIfacialmocapHello =
    "iFacialMocap_sahuasouryya9218sauhuiayeta91555dy3719";

// The separator between names and values for the sender of a hello: '-', or '&' if it requests
// version 2; nothing if the datagram is not a hello.
[[nodiscard]] std::optional<char> ifacialmocap_separator(std::string_view datagram);

// Names such as "eyeBlink_L" and integer values 0..100, then head, right and left eye in degrees: x
// is our pitch, y our negative yaw, z our roll; then the head position in metres, camera space.
[[nodiscard]] std::string ifacialmocap_text(const animation::Frame& frame, char separator);

}  // namespace mien::protocols
