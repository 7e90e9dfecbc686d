// The bytes are a neutral file, as they are and with their checksum made right. What is accepted is
// written back as it was.
#include "formats/neutral_file.h"

#include <cmath>
#include <cstring>
#include <vector>

#include "formats/xxhash64.h"
#include "fuzz/bytes.h"
#include "fuzz/target.h"

namespace {

using namespace mien::formats;

void read(std::span<const std::byte> bytes) {
  NeutralFile neutral;
  if (read_neutral_file(bytes, neutral) != NeutralFileError::kNone) {
    return;
  }
  for (const float level : neutral.levels) {
    mien::fuzz::require(level >= 0.0f && level <= 1.0f);
  }
  std::byte again[kNeutralFileBytes];
  write_neutral_file(neutral, again);
  NeutralFile second;
  mien::fuzz::require(read_neutral_file(again, second) == NeutralFileError::kNone);
  mien::fuzz::require(std::memcmp(&neutral, &second, sizeof neutral) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  read(bytes);
  // A file that is right, with what the input says at a place that it says.
  mien::fuzz::Bytes choices(data, size);
  NeutralFile neutral;
  neutral.captured = choices.take<std::uint32_t>() % 4;
  std::byte file[kNeutralFileBytes];
  write_neutral_file(neutral, file);
  while (!choices.empty()) {
    const auto at = static_cast<std::size_t>(choices.between(0, kNeutralFileBytes - 1));
    file[at] = static_cast<std::byte>(choices.take<std::uint8_t>());
  }
  read(file);
  return 0;
}
