// Images and sounds that an input describes: right ones in memory of their exact size, and wrong
// ones.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <vector>

#include "fuzz/bytes.h"

namespace mien::fuzz {

// Right ones may be read whole; wrong ones have to be refused before a byte is read. `memory` is
// theirs.
[[nodiscard]] mien_image take_image(Bytes& choices, std::vector<std::byte> (&memory)[3]);
[[nodiscard]] mien_audio take_audio(Bytes& choices, std::vector<std::byte>& memory);

}  // namespace mien::fuzz
