// Arithmetic of timestamps in nanoseconds, which may have any value: modulo 2^64, without overflow.
#pragma once

#include <cstdint>

namespace mien::audio {

[[nodiscard]] constexpr std::int64_t later(std::int64_t time_ns, std::int64_t by_ns) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(time_ns) +
                                   static_cast<std::uint64_t>(by_ns));
}

// b - a.
[[nodiscard]] constexpr std::int64_t from_to(std::int64_t a_ns, std::int64_t b_ns) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(b_ns) -
                                   static_cast<std::uint64_t>(a_ns));
}

}  // namespace mien::audio
