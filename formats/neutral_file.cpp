// Reads and writes neutral files.
#include "formats/neutral_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>

#include "formats/xxhash64.h"

namespace mien::formats {
namespace {

constexpr std::string_view kMagic = "MIENNEUT";
constexpr std::uint32_t kMajor = 1;
constexpr std::uint32_t kControls = 52;
constexpr std::size_t kMajorAt = 8;  // u16; the minor version follows, which readers ignore
constexpr std::size_t kControlsAt = 12;
constexpr std::size_t kCapturedAt = 16;
constexpr std::size_t kLevelsAt = 24;
constexpr std::size_t kChecksumAt = kLevelsAt + 4 * kNeutralLevels;
static_assert(kChecksumAt + 8 == kNeutralFileBytes);

void put(std::span<std::byte> bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    bytes[at + i] = static_cast<std::byte>(value >> (8 * i));
  }
}

std::uint64_t get(std::span<const std::byte> bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    value |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
  }
  return value;
}

bool has_magic(std::span<const std::byte> bytes) {
  return bytes.size() >= kMagic.size() &&
         std::equal(kMagic.begin(), kMagic.end(), bytes.begin(),
                    [](char c, std::byte b) { return static_cast<std::byte>(c) == b; });
}

}  // namespace

void write_neutral_file(const NeutralFile& neutral, std::span<std::byte, kNeutralFileBytes> bytes) {
  std::fill(bytes.begin(), bytes.end(), std::byte{0});
  std::transform(kMagic.begin(), kMagic.end(), bytes.begin(),
                 [](char c) { return static_cast<std::byte>(c); });
  put(bytes, kMajorAt, kMajor, 2);
  put(bytes, kControlsAt, kControls, 4);
  put(bytes, kCapturedAt, neutral.captured, 4);
  for (std::size_t i = 0; i < kNeutralLevels; ++i) {
    put(bytes, kLevelsAt + 4 * i, std::bit_cast<std::uint32_t>(neutral.levels[i]), 4);
  }
  put(bytes, kChecksumAt, xxhash64_with_hole(bytes, kChecksumAt), 8);
}

mien_status read_neutral_file(std::span<const std::byte> bytes, NeutralFile& neutral) {
  if (!has_magic(bytes)) {
    return MIEN_ERROR_NEUTRAL_FORMAT;
  }
  if (bytes.size() >= kMajorAt + 2 && get(bytes, kMajorAt, 2) != kMajor) {
    return MIEN_ERROR_NEUTRAL_VERSION;
  }
  if (bytes.size() != kNeutralFileBytes ||
      get(bytes, kChecksumAt, 8) != xxhash64_with_hole(bytes, kChecksumAt) ||
      get(bytes, kControlsAt, 4) != kControls) {
    return MIEN_ERROR_NEUTRAL_DAMAGED;
  }
  NeutralFile read;
  read.captured = static_cast<std::uint32_t>(get(bytes, kCapturedAt, 4));
  for (std::size_t i = 0; i < kNeutralLevels; ++i) {
    const auto bits = static_cast<std::uint32_t>(get(bytes, kLevelsAt + 4 * i, 4));
    read.levels[i] = std::bit_cast<float>(bits);
    if (!(read.levels[i] >= 0.0f && read.levels[i] <= 1.0f)) {
      return MIEN_ERROR_NEUTRAL_DAMAGED;
    }
  }
  neutral = read;
  return MIEN_OK;
}

}  // namespace mien::formats
