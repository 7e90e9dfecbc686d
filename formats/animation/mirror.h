// A face as a mirror shows it.
#pragma once

#include "formats/animation/clip.h"

namespace mien::formats {

// Left and right exchanged in controls, eyes, and the head's turn and place; units of other
// vocabularies are left out. The box stays where it is in the picture.
[[nodiscard]] Frame mirrored(const Frame& frame);

}  // namespace mien::formats
