// Neutral files: what a person's face shows at rest, for the next time. docs/format.md has the
// layout.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mien::formats {

inline constexpr std::size_t kNeutralLevels = 104;  // 52 controls of two decoders
inline constexpr std::size_t kNeutralFileBytes = 448;

struct NeutralFile {
  std::uint32_t captured = 0;         // bit i: the 52 levels of decoder i are
  float levels[kNeutralLevels] = {};  // 0..1
};

enum class NeutralFileError {
  kNone,
  kNotANeutralFile,
  kVersion,
  kDamaged,  // truncated or too long, wrong checksum, or a level that is none
};

void write_neutral_file(const NeutralFile& neutral, std::span<std::byte, kNeutralFileBytes> bytes);

// On an error `neutral` stays as it was.
[[nodiscard]] NeutralFileError read_neutral_file(std::span<const std::byte> bytes,
                                                 NeutralFile& neutral);

}  // namespace mien::formats
