// Allocates memory between two inaccessible pages.
#pragma once

#include <cstddef>
#include <span>

namespace mien::conformance {

// `bytes` is rounded up to whole pages, or to 64 on systems without page protection. Throws
// std::bad_alloc.
[[nodiscard]] std::span<std::byte> make_guarded_memory(std::size_t bytes);
void release_guarded_memory(std::span<std::byte> memory);

}  // namespace mien::conformance
