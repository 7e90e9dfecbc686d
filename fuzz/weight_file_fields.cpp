// The bytes are a weight file whose magic, version, size and checksum are corrected first, so that
// mutations reach the later checks.
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include "formats/mien_format.h"
#include "formats/xxhash64.h"
#include "fuzz/read_all.h"
#include "fuzz/target.h"

namespace {

using mien::formats::FileHeader;

void correct_header(std::vector<std::byte>& file) {
  FileHeader header;
  std::memcpy(&header, file.data(), sizeof header);
  std::memcpy(header.magic, mien::formats::kMagic, sizeof header.magic);
  header.major_version = mien::formats::kMajorVersion;
  header.minor_version = std::min(header.minor_version, mien::formats::kMinorVersion);
  header.endian_tag = mien::formats::kEndianTag;
  header.header_bytes = sizeof header;
  header.total_bytes = file.size();
  std::memcpy(file.data(), &header, sizeof header);
  header.checksum = mien::formats::xxhash64_with_hole(file, offsetof(FileHeader, checksum));
  std::memcpy(file.data(), &header, sizeof header);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  std::vector<std::byte> file(bytes.begin(), bytes.end());
  if (file.size() >= sizeof(FileHeader)) {
    correct_header(file);
  }
  mien::fuzz::read_all(file);
  return 0;
}
