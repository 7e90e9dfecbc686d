// Neutral files store a person's neutral calibration for the next run. docs/format.md specifies the
// layout.
#pragma once

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

enum class NeutralFileError {
  kNone,
  kNotANeutralFile,
  kVersion,
  kDamaged,  // wrong size, wrong checksum, or a level out of range
};

void write_neutral_file(const NeutralFile& neutral, std::span<std::byte, kNeutralFileBytes> bytes);

// `neutral` is unchanged on error.
[[nodiscard]] NeutralFileError read_neutral_file(std::span<const std::byte> bytes,
                                                 NeutralFile& neutral);

}  // namespace mien::formats
