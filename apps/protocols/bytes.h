// Appends numbers to packets.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <type_traits>

namespace mien::protocols {

template <typename Unsigned>
requires std::is_unsigned_v<Unsigned>
void append_big(std::string& packet, Unsigned value) {
  for (int shift = 8 * (static_cast<int>(sizeof(Unsigned)) - 1); shift >= 0; shift -= 8) {
    packet += static_cast<char>(static_cast<unsigned char>(value >> shift));
  }
}

template <typename Unsigned>
requires std::is_unsigned_v<Unsigned>
void append_little(std::string& packet, Unsigned value) {
  for (std::size_t byte = 0; byte < sizeof(Unsigned); ++byte) {
    packet += static_cast<char>(static_cast<unsigned char>(value >> (8 * byte)));
  }
}

// As fp32.
inline void append_big_float(std::string& packet, double value) {
  append_big(packet, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}
inline void append_little_float(std::string& packet, double value) {
  append_little(packet, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}
inline void append_little_double(std::string& packet, double value) {
  append_little(packet, std::bit_cast<std::uint64_t>(value));
}

}  // namespace mien::protocols
