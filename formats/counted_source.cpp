// Reads and skips bytes while counting them.
#include "formats/counted_source.h"

#include <algorithm>
#include <array>

namespace mien::formats {

std::size_t CountedSource::read(std::span<std::byte> into) {
  const std::size_t bytes = source_.read(source_.context, into);
  position_ += bytes;
  return bytes;
}

// Reads instead of seeking, because pipes cannot seek.
bool CountedSource::skip(std::uint64_t bytes) {
  std::array<std::byte, 4096> skipped;
  while (bytes > 0) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, skipped.size()));
    if (read(std::span(skipped).first(part)) < part) {
      return false;
    }
    bytes -= part;
  }
  return true;
}

}  // namespace mien::formats
