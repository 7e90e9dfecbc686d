// Reads Netpbm images, binary with 8 bits: PGM (P5) and PPM (P6).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mien::formats {

enum class PnmStatus : std::uint8_t {
  kOk = 0,
  kBadSignature = 1,
  kBadHeader = 2,
  kBadSize = 3,
  kUnsupportedDepth = 4,
  kTruncated = 5,
  kTrailingBytes = 6,
};
inline constexpr std::uint8_t kPnmStatusCount = 7;

const char* message(PnmStatus status);

inline constexpr std::uint32_t kMaxImageSide = 16384;  // pixels

struct PnmImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t channels = 0;         // 1: grey; 3: red, green, blue
  std::span<const std::byte> pixels;  // [height][width][channels], inside the file's bytes
};

// `file` must be one complete image with maximum value 255. `*image` is empty on failure.
[[nodiscard]] PnmStatus read_pnm(std::span<const std::byte> file, PnmImage* image);

}  // namespace mien::formats
