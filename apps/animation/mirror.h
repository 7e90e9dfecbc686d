// Mirrors a face.
#pragma once

#include "apps/animation/clip.h"

namespace mien::animation {

// Exchanges left and right in controls, eyes, and head pose. Drops values of other vocabularies,
// and keeps the box.
[[nodiscard]] Frame mirrored(const Frame& frame);

}  // namespace mien::animation
