// Packed weight files: compressed .mien files for programs that embed their weights. docs/format.md
// specifies the layout; scripts/package/pack_weights.py creates them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/error_detail.h"

namespace mien::formats {

inline constexpr std::uint8_t kPackedMagic[8] = {0x89, 'M', 'I', 'E', 'P', 0x0D, 0x0A, 0x1A};
inline constexpr std::size_t kPackedBytesAt = 16;  // u64: size of the packed file
inline constexpr std::size_t kPackedHeaderBytes = 32;

// Checks the header. On MIEN_OK, `bytes` receives the unpacked size, at most 2^31; else it is
// unchanged, and `error` describes the error.
[[nodiscard]] mien_status unpacked_bytes(std::span<const std::byte> packed, std::size_t& bytes,
                                         mien_error_detail& error);

// Unpacks to `file`, which has exactly unpacked_bytes and must not overlap `packed`. If a block is
// malformed, `file` is all zeros. `error` describes an error.
[[nodiscard]] mien_status unpack(std::span<const std::byte> packed, std::span<std::byte> file,
                                 mien_error_detail& error);

}  // namespace mien::formats
