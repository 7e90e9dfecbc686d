// A byte source that knows how far it was read.
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

  // As ByteSource::read: fewer bytes than asked only at the end.
  [[nodiscard]] std::size_t read(std::span<std::byte> into);

  // False if the source ends before that.
  [[nodiscard]] bool skip(std::uint64_t bytes);

 private:
  ByteSource source_{};
  std::uint64_t position_ = 0;
};

}  // namespace mien::formats
