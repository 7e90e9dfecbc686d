// Copies structs of the C API between versions of the library: `struct_size` is the size that the
// caller knows.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace mien::tracker {

// Size of T up to and including `member`, which may be a pointer.
// NOLINTNEXTLINE(bugprone-sizeof-expression)
#define MIEN_SIZE_THROUGH(T, member) (offsetof(T, member) + sizeof(T::member))

// Copies `from`, as far as its size goes, over the defaults in `to`. False if it is smaller than
// `min_bytes`.
template <typename T>
[[nodiscard]] bool read_struct(const T& from, std::size_t min_bytes, T& to) {
  if (from.struct_size < min_bytes) {
    return false;
  }
  std::memcpy(&to, &from, std::min<std::size_t>(from.struct_size, sizeof(T)));
  to.struct_size = sizeof(T);
  return true;
}

// Copies `from` into `to`, as far as its size goes, and zeroes the rest of `to`. False if `to` is
// smaller than `min_bytes`.
template <typename T>
[[nodiscard]] bool write_struct(const T& from, std::size_t min_bytes, T* to) {
  const std::uint32_t size = to->struct_size;
  if (size < min_bytes) {
    return false;
  }
  auto* bytes = reinterpret_cast<std::byte*>(to);
  const std::size_t copied = std::min<std::size_t>(size, sizeof(T));
  std::memcpy(bytes, &from, copied);
  std::memset(bytes + copied, 0, size - copied);
  std::memcpy(bytes, &size, sizeof size);
  return true;
}

}  // namespace mien::tracker
