// The bytes are a Y4M stream.
#include "formats/y4m.h"

#include <algorithm>
#include <vector>

#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using mien::formats::Y4mStatus;
  std::span<const std::byte> left = std::as_bytes(std::span(data, size));
  mien::formats::Y4mReader reader;
  Y4mStatus status = reader.open(mien::formats::span_source(&left));
  // The buffer holds every frame that the input could fill; larger frames are rejected.
  std::vector<std::byte> frame(std::min(reader.header().frame_bytes(), size + 1));
  while (status == Y4mStatus::kOk) {
    status = reader.read_frame(frame);
  }
  return 0;
}
