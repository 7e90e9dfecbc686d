// Byte sources for C streams and spans.
#include "formats/byte_source.h"

#include <algorithm>
#include <cstring>

namespace mien::formats {

ByteSource file_source(std::FILE* file) {
  const auto read = [](void* context, std::span<std::byte> into) {
    return std::fread(into.data(), 1, into.size(), static_cast<std::FILE*>(context));
  };
  return {read, file};
}

ByteSource span_source(std::span<const std::byte>* remaining) {
  const auto read = [](void* context, std::span<std::byte> into) {
    auto& left = *static_cast<std::span<const std::byte>*>(context);
    const std::size_t count = std::min(left.size(), into.size());
    if (count > 0) {
      std::memcpy(into.data(), left.data(), count);
    }
    left = left.subspan(count);
    return count;
  };
  return {read, remaining};
}

}  // namespace mien::formats
