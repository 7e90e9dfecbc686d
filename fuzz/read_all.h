// Reads everything a view of a weight file hands out, so that a sanitizer sees what lies outside.
#pragma once

#include <cstddef>
#include <span>

namespace mien::fuzz {

// `file` is copied to aligned memory that ends where it ends. Stops the program where a view breaks
// a promise: an accepted file whose strings, tensors or references do not hold together.
void read_all(std::span<const std::byte> file);

}  // namespace mien::fuzz
