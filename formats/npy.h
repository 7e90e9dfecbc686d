// Reads and writes NumPy's .npy files of floating-point arrays, versions 1 to 3 (NumPy enhancement
// proposal 1 and numpy.lib.format).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mien::formats {

enum class NpyStatus : std::uint8_t {
  kOk = 0,
  kBadSignature = 1,
  kUnsupportedVersion = 2,
  kBadHeader = 3,
  kUnsupportedType = 4,
  kFortranOrder = 5,
  kBadShape = 6,
  kTruncated = 7,
  kTrailingBytes = 8,
};
inline constexpr std::uint8_t kNpyStatusCount = 9;

[[nodiscard]] const char* message(NpyStatus status);

enum class NpyType : std::uint8_t { kFloat32, kFloat64 };

inline constexpr std::uint32_t kMaxNpyRank = 8;
inline constexpr std::uint64_t kMaxNpyElems = std::uint64_t{1} << 32;

struct NpyArray {
  NpyType type = NpyType::kFloat32;
  std::uint32_t rank = 0;
  std::uint64_t dims[kMaxNpyRank] = {};  // outermost first; may be 0
  std::span<const std::byte> data;       // little-endian, C order, inside the file's bytes;
                                         // unaligned

  [[nodiscard]] std::span<const std::uint64_t> shape() const { return {dims, rank}; }
  [[nodiscard]] std::uint64_t elems() const;
  // Element i < elems(), rounded to float.
  [[nodiscard]] float value(std::uint64_t i) const;
};

// `file` must be one complete array. `*array` is empty on failure.
[[nodiscard]] NpyStatus read_npy(std::span<const std::byte> file, NpyArray* array);

// The header of a float32 array in C order, version 1.0.
inline constexpr std::size_t kNpyHeaderBytes = 256;
struct NpyHeader {
  char bytes[kNpyHeaderBytes];
};
// At most kMaxNpyRank dimensions.
[[nodiscard]] NpyHeader npy_header(std::span<const std::uint64_t> shape);

}  // namespace mien::formats
