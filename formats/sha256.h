// SHA-256 (FIPS 180-4).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mien::formats {

class Sha256 {
 public:
  void update(std::span<const std::byte> bytes);
  // Ends the message; the object is used up.
  std::array<std::uint8_t, 32> finish();

 private:
  void compress(const std::byte* block);

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::byte, 64> pending_{};
  std::uint64_t message_bytes_ = 0;
};

}  // namespace mien::formats
