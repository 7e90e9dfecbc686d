// C API: packed weights.
#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/packed_file.h"

namespace {

using mien::formats::PackedStatus;

mien_status status_of(PackedStatus status) {
  switch (status) {
    case PackedStatus::kOk:
      return MIEN_OK;
    case PackedStatus::kTruncated:
      return MIEN_ERROR_WEIGHTS_TRUNCATED;
    case PackedStatus::kNotPacked:
      return MIEN_ERROR_WEIGHTS_NOT_PACKED;
    case PackedStatus::kUnsupportedVersion:
      return MIEN_ERROR_WEIGHTS_VERSION;
    default:
      return MIEN_ERROR_WEIGHTS_MALFORMED;
  }
}

}  // namespace

mien_status mien_unpacked_bytes(const void* packed, size_t packed_bytes, size_t* unpacked_bytes) {
  if (packed == nullptr || unpacked_bytes == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  return status_of(mien::formats::unpacked_bytes(
      {static_cast<const std::byte*>(packed), packed_bytes}, *unpacked_bytes));
}

mien_status mien_unpack(const void* packed, size_t packed_bytes, void* file, size_t file_bytes) {
  if (packed == nullptr || file == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  if (reinterpret_cast<std::uintptr_t>(file) % MIEN_ALIGNMENT != 0) {
    return MIEN_ERROR_ALIGNMENT;
  }
  const std::span<const std::byte> bytes(static_cast<const std::byte*>(packed), packed_bytes);
  std::size_t needed = 0;
  const PackedStatus status = mien::formats::unpacked_bytes(bytes, needed);
  if (status != PackedStatus::kOk) {
    return status_of(status);
  }
  if (needed > file_bytes) {
    return MIEN_ERROR_MEMORY_TOO_SMALL;
  }
  return status_of(mien::formats::unpack(bytes, {static_cast<std::byte*>(file), needed}));
}
