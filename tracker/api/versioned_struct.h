// Structs of the C interface as their caller knew them: `struct_size` says how far they reach.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace mien::tracker {

// Size of T up to and including `member`.
#define MIEN_SIZE_THROUGH(T, member) (offsetof(T, member) + sizeof(T::member))

// Copies what `from` has over the defaults in `to`. False when it has less than `least_bytes`.
template <typename T>
[[nodiscard]] bool read_struct(const T& from, std::size_t least_bytes, T& to) {
  if (from.struct_size < least_bytes) {
    return false;
  }
  std::memcpy(&to, &from, std::min<std::size_t>(from.struct_size, sizeof(T)));
  to.struct_size = sizeof(T);
  return true;
}

// Copies as much of `from` as `to` has room for, and zeros what lies beyond. False when `to` has
// room for less than `least_bytes`.
template <typename T>
[[nodiscard]] bool write_struct(const T& from, std::size_t least_bytes, T* to) {
  const std::uint32_t size = to->struct_size;
  if (size < least_bytes) {
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
