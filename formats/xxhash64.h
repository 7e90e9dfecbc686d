// XXH64 (Y. Collet, "xxHash fast digest algorithm", specification 0.1.1): the checksum of weight
// files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mien::formats {

// Hash of `bytes` with seed 0. The bytes [hole, hole + 8), where the file stores its checksum,
// count as zero.
[[nodiscard]] std::uint64_t xxhash64_with_hole(std::span<const std::byte> bytes, std::size_t hole);

}  // namespace mien::formats
