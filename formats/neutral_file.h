// Neutral files store a person's neutral calibration for the next run. docs/format.md specifies the
// layout.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace mien::formats {

inline constexpr std::size_t kNeutralLevels = 104;  // 52 controls of each of two decoders
inline constexpr std::size_t kNeutralFileBytes = 448;

struct NeutralFile {
  std::uint32_t captured = 0;         // bit i: the 52 levels of decoder i are valid
  float levels[kNeutralLevels] = {};  // 0..1
};

void write_neutral_file(const NeutralFile& neutral, std::span<std::byte, kNeutralFileBytes> bytes);

// `neutral` is unchanged on error, which is MIEN_ERROR_NEUTRAL_FORMAT, MIEN_ERROR_NEUTRAL_VERSION,
// or MIEN_ERROR_NEUTRAL_DAMAGED for a wrong size, a wrong checksum, or a level out of range.
[[nodiscard]] mien_status read_neutral_file(std::span<const std::byte> bytes, NeutralFile& neutral);

}  // namespace mien::formats
