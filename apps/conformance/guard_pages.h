// Memory between two pages that may not be touched, from the system.
#pragma once

#include <cstddef>
#include <span>

namespace mien::conformance {

// `bytes` rounded up to whole pages, where there are pages to protect; else to 64. Throws
// std::bad_alloc.
[[nodiscard]] std::span<std::byte> make_guarded_room(std::size_t bytes);
void release_guarded_room(std::span<std::byte> room);

}  // namespace mien::conformance
