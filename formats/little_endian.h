// Little-endian numbers in files, at any alignment.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::formats {

// Reads sizeof(Unsigned) bytes at `bytes`.
template <typename Unsigned>
[[nodiscard]] constexpr Unsigned load_little(const std::byte* bytes) {
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    value |= static_cast<Unsigned>(std::to_integer<Unsigned>(bytes[i]) << (8 * i));
  }
  return value;
}

}  // namespace mien::formats
