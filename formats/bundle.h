// Bundles: several weight files, packed or not, one after another.
#pragma once

#include <cstddef>
#include <span>

namespace mien::formats {

// Whether `bytes` begin as a packed weight file does.
[[nodiscard]] bool is_packed(std::span<const std::byte> bytes);

// Whether `bytes` begin as a weight file does, packed or not.
[[nodiscard]] bool is_weight_file(std::span<const std::byte> bytes);

// Size of the file at the start of a bundle, as its header declares it. All bytes if there is no
// header, or if it declares more than there is.
[[nodiscard]] std::size_t first_file_bytes(std::span<const std::byte> bundle);

}  // namespace mien::formats
