// Finds the files of a bundle.
#include "formats/bundle.h"

#include <cstdint>
#include <cstring>

#include "formats/little_endian.h"
#include "formats/mien_format.h"
#include "formats/packed_file.h"

namespace mien::formats {
namespace {

template <std::size_t N>
bool begins_with(std::span<const std::byte> bytes, const std::uint8_t (&magic)[N]) {
  return bytes.size() >= N && std::memcmp(bytes.data(), magic, N) == 0;
}

}  // namespace

bool is_packed(std::span<const std::byte> bytes) { return begins_with(bytes, kPackedMagic); }

bool is_weight_file(std::span<const std::byte> bytes) {
  return is_packed(bytes) || begins_with(bytes, kMagic);
}

std::size_t first_file_bytes(std::span<const std::byte> bundle) {
  const bool packed = is_packed(bundle);
  const std::size_t header = packed ? kPackedHeaderBytes : sizeof(FileHeader);
  if (bundle.size() < header || !is_weight_file(bundle)) {
    return bundle.size();
  }
  const std::size_t at = packed ? kPackedBytesAt : offsetof(FileHeader, total_bytes);
  const auto declared = load_little<std::uint64_t>(bundle.data() + at);
  return declared >= header && declared <= bundle.size() ? static_cast<std::size_t>(declared)
                                                         : bundle.size();
}

}  // namespace mien::formats
