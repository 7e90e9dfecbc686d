// Why a weight file was refused, and where.
#pragma once

#include <cstdint>

namespace mien::formats {

// Numbers are fixed and never reused.
enum class FileStatus : std::uint8_t {
  kOk = 0,
  kTruncated = 1,
  kMisaligned = 2,
  kBadMagic = 3,
  kWrongEndian = 4,
  kUnsupportedVersion = 5,
  kBadHeaderSize = 6,
  kReservedNotZero = 7,
  kLimitExceeded = 8,
  kSizeMismatch = 9,
  kTrailingBytes = 10,
  kBadChecksum = 11,
  kPaddingNotZero = 12,
  kHole = 13,
  kOverlap = 14,
  kBadName = 15,
  kDuplicateName = 16,
  kBadText = 17,
  kBadOp = 18,
  kBadActivation = 19,
  kBadDataType = 20,
  kBadInput = 21,
  kBadGeometry = 22,
  kBadShape = 23,
  kBadReference = 24,
  kBadTensor = 25,
  kUnusedLayer = 26,
  kNonFinite = 27,
};
inline constexpr std::uint8_t kFileStatusCount = 28;

struct [[nodiscard]] FileError {
  FileStatus status = FileStatus::kOk;
  std::uint64_t byte_offset = 0;  // of the field or byte at fault, from the file's start
  explicit operator bool() const { return status != FileStatus::kOk; }
};

// One English sentence, never null; lives forever.
const char* message(FileStatus status);

}  // namespace mien::formats
