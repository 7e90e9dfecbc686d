// The bytes are a neutral file, or changes of a valid one. An accepted file is unchanged after it
// is written and read again.
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
  if (read_neutral_file(bytes, neutral) != MIEN_OK) {
    return;
  }
  for (const float level : neutral.levels) {
    mien::fuzz::require(level >= 0.0f && level <= 1.0f);
  }
  std::byte again[kNeutralFileBytes];
  write_neutral_file(neutral, again);
  NeutralFile second;
  mien::fuzz::require(read_neutral_file(again, second) == MIEN_OK);
  mien::fuzz::require(std::memcmp(&neutral, &second, sizeof neutral) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  read(bytes);
  // A valid file in which the input overwrites bytes.
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
