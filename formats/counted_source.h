// A byte source that counts the bytes read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/byte_source.h"

namespace mien::formats {

class CountedSource {
 public:
  CountedSource() = default;
  explicit CountedSource(ByteSource source) : source_(source) {}

  // Bytes read and skipped so far.
  [[nodiscard]] std::uint64_t position() const { return position_; }

  // Like ByteSource::read: less than into.size() only at the end.
  [[nodiscard]] std::size_t read(std::span<std::byte> into);

  // Returns false if the source ends earlier.
  [[nodiscard]] bool skip(std::uint64_t bytes);

 private:
  ByteSource source_{};
  std::uint64_t position_ = 0;
};

}  // namespace mien::formats
