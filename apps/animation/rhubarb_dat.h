// Switch data of Moho and OpenToonz (.dat): frames, 24 per second, and names of mouth shapes.
#pragma once

#include <cstdint>
#include <string_view>

#include "apps/animation/clip.h"

namespace mien::animation {

inline constexpr std::string_view kDatHead = "MohoSwitch1";
inline constexpr std::int64_t kDatFps = 24;

// Frames count from 1. The addition compensates rounding of times to nanoseconds.
[[nodiscard]] constexpr std::int64_t dat_frame(std::int64_t time_ns) {
  const std::int64_t second = (time_ns + 1) / kSecond_ns, rest_ns = (time_ns + 1) % kSecond_ns;
  return 1 + second * kDatFps + rest_ns * kDatFps / kSecond_ns;
}

// The inverse.
[[nodiscard]] constexpr std::int64_t dat_time(std::int64_t frame) {
  const std::int64_t second = (frame - 1) / kDatFps, rest = (frame - 1) % kDatFps;
  return second * kSecond_ns + (rest * kSecond_ns + kDatFps / 2) / kDatFps;
}

}  // namespace mien::animation
