// Reads everything that a view of a weight file provides, so that a sanitizer detects accesses
// outside the file.
#pragma once

#include <cstddef>
#include <span>

namespace mien::fuzz {

// Copies `file` to aligned memory of its exact size. Stops the program if the strings, tensors or
// references of an accepted file are inconsistent.
void read_all(std::span<const std::byte> file);

}  // namespace mien::fuzz
