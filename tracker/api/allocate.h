// Allocates memory with the caller's callbacks, or with operator new without them.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <new>

namespace mien::tracker {

// MIEN_ALIGNMENT-aligned; nullptr if no memory is available.
inline void* allocate(const mien_allocator& allocator, std::size_t bytes) {
  if (allocator.allocate != nullptr) {
    return allocator.allocate(allocator.user, bytes, MIEN_ALIGNMENT);
  }
  return ::operator new(bytes, std::align_val_t(MIEN_ALIGNMENT), std::nothrow);
}

// Both callbacks or none.
[[nodiscard]] inline bool is_valid(const mien_allocator& allocator) {
  return (allocator.allocate == nullptr) == (allocator.release == nullptr);
}

inline void release(const mien_allocator& allocator, void* memory) {
  if (allocator.release != nullptr) {
    allocator.release(allocator.user, memory);
  } else {
    ::operator delete(memory, std::align_val_t(MIEN_ALIGNMENT));
  }
}

}  // namespace mien::tracker
