// Marks initialized memory as uninitialized for clang's memory sanitizer. NaNs alone only show if
// they reach a result; a maximum or a mask can drop them.
#pragma once

#include <cstddef>
#include <span>

#ifdef __has_feature
#if __has_feature(memory_sanitizer)
#include <sanitizer/msan_interface.h>
#define MIEN_MEMORY_SANITIZER
#endif
#endif

namespace mien {

inline void count_as_unwritten([[maybe_unused]] std::span<std::byte> bytes) {
#ifdef MIEN_MEMORY_SANITIZER
  __msan_poison(bytes.data(), bytes.size());
#endif
}

}  // namespace mien
