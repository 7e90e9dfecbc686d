// The bytes are a packed weight file, unchanged and with a corrected header, so that mutations
// reach the blocks after it.
#include "formats/packed_file.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "fuzz/bytes.h"
#include "fuzz/target.h"

namespace {

using namespace mien::formats;

constexpr unsigned char kValidStart[] = {0x89, 'M', 'I', 'E', 'P', 0x0D, 0x0A, 0x1A,
                                         1,    0,   0,   0,   0,   0,    0,    0};
constexpr std::size_t kUnpackedBytesAt = 24;
constexpr std::size_t kHeaderBytes = 32;
constexpr std::uint64_t kMaxUnpacked = 1 << 18;

void read(std::span<const std::byte> packed) {
  std::size_t bytes = 0;
  mien_error_detail error = detail_of(MIEN_OK);
  const auto in_file = [&] { return error.offset <= packed.size(); };
  if (unpacked_bytes(packed, bytes, error) != MIEN_OK) {
    mien::fuzz::require(bytes == 0 && error.status != MIEN_OK && in_file());
    return;
  }
  mien::fuzz::require(bytes > 0 && bytes <= 820 * packed.size());
  std::vector<std::byte> file(bytes, std::byte{0xAA});
  const mien_status status = unpack(packed, file, error);
  if (status != MIEN_OK) {
    mien::fuzz::require(std::ranges::count(file, std::byte{0}) == std::ssize(file));
    mien::fuzz::require(error.status == status && in_file());
    return;
  }
  std::vector<std::byte> again(bytes);
  mien::fuzz::require(unpack(packed, again, error) == MIEN_OK && file == again);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  read(bytes);
  if (size < kHeaderBytes) {
    return 0;
  }
  std::vector<std::byte> corrected(bytes.begin(), bytes.end());
  std::memcpy(corrected.data(), kValidStart, sizeof kValidStart);
  const std::uint64_t packed_bytes = size;
  std::memcpy(corrected.data() + kPackedBytesAt, &packed_bytes, sizeof packed_bytes);
  std::uint64_t unpacked = 0;
  std::memcpy(&unpacked, corrected.data() + kUnpackedBytesAt, sizeof unpacked);
  unpacked = unpacked % kMaxUnpacked / 64 * 64;
  std::memcpy(corrected.data() + kUnpackedBytesAt, &unpacked, sizeof unpacked);
  read(corrected);
  return 0;
}
