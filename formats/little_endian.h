// Numbers that files store with their lowest byte first, wherever in memory they begin.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::formats {

// Reads sizeof(Unsigned) bytes from `bytes` on.
template <typename Unsigned>
[[nodiscard]] constexpr Unsigned load_little(const std::byte* bytes) {
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    value |= static_cast<Unsigned>(std::to_integer<Unsigned>(bytes[i]) << (8 * i));
  }
  return value;
}

}  // namespace mien::formats
