// Packed weight files: compressed .mien files for programs that embed their weights. docs/format.md
// specifies the layout; scripts/package/pack_weights.py creates them.
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
  kBadSize = 6,    // unpacked size out of range
  kWrongSize = 7,  // the memory does not have the unpacked size
  // blocks
  kBadBlock = 20,  // size of a block
  kBadTable = 21,
  kBadState = 22,  // of a decoder, at the start or the end
  kBytesMissing = 23,
  kBytesLeft = 24,
};

// Checks the header. On kOk, `bytes` receives the unpacked size, at most 2^31; else it is
// unchanged.
[[nodiscard]] PackedStatus unpacked_bytes(std::span<const std::byte> packed, std::size_t& bytes);

// Unpacks to `file`, which has exactly unpacked_bytes and must not overlap `packed`. If a block is
// malformed, `file` is all zeros.
[[nodiscard]] PackedStatus unpack(std::span<const std::byte> packed, std::span<std::byte> file);

}  // namespace mien::formats
