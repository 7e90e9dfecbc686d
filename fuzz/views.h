// Images and audio blocks that an input describes: valid ones in memory of their exact size, and
// invalid ones.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <vector>

#include "fuzz/bytes.h"

namespace mien::fuzz {

// The library may read all of a valid one, and must reject an invalid one before it reads a byte.
// `memory` holds the samples.
[[nodiscard]] mien_image take_image(Bytes& choices, std::vector<std::byte> (&memory)[3]);
[[nodiscard]] mien_audio take_audio(Bytes& choices, std::vector<std::byte>& memory);

}  // namespace mien::fuzz
