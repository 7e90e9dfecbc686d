// Packed weight files: a .mien file without what it repeats, for programs that carry their weights.
// docs/format.md has the layout, scripts/package/pack_weights.py makes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mien::formats {

enum class PackedStatus : std::int32_t {
  kOk = 0,
  // the file as a whole
  kTruncated = 1,
  kTrailingBytes = 2,
  kNotPacked = 3,
  kUnsupportedVersion = 4,
  kReservedNotZero = 5,
  kBadSize = 6,    // of what it is unpacked to
  kWrongSize = 7,  // of the memory that it is unpacked to
  // blocks
  kBadBlock = 20,  // its size
  kBadTable = 21,
  kBadState = 22,  // of a coder, at the beginning or the end
  kBytesMissing = 23,
  kBytesLeft = 24,
};

// Checks the header. Only on kOk is `bytes` set: how many there are unpacked, at most 2^31.
[[nodiscard]] PackedStatus unpacked_bytes(std::span<const std::byte> packed, std::size_t& bytes);

// Fills `file`, which has exactly unpacked_bytes and does not overlap `packed`. If a block is found
// to be broken on the way, `file` is zeros.
[[nodiscard]] PackedStatus unpack(std::span<const std::byte> packed, std::span<std::byte> file);

}  // namespace mien::formats
