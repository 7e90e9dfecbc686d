// iFacialMocap over UDP, port 49983, as a phone speaks it (ifacialmocap.com/for-developer): whoever
// says the hello gets a stream of text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "formats/animation/clip.h"

namespace mien::formats {

inline constexpr std::string_view kIfacialmocapHello =
    "iFacialMocap_sahuasouryya9218sauhuiayeta91555dy3719";

// What stands between names and values for whoever sent this: '-', or '&' where the hello asks for
// version 2; nothing where it is no hello.
[[nodiscard]] std::optional<char> ifacialmocap_separator(std::string_view datagram);

// Names as "eyeBlink_L", values 0..100 in whole numbers, then head, right and left eye in degrees:
// x as our pitch, y against our yaw, z as our roll; the head's place in metres, camera space.
[[nodiscard]] std::string ifacialmocap_text(const Frame& frame, char separator);

}  // namespace mien::formats
