// Memory that a test has filled and that counts as written by nobody, where clang's memory
// sanitizer watches: filled with NaNs it is noticed only if they reach a result, and a maximum or a
// mask can drop them.
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
