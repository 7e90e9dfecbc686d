// Converts the controls of a frame to other vocabularies.
#pragma once

#include <vector>

#include "apps/animation/frame.h"

namespace mien::app {

// The values of a mien_vocabulary, in its order. Unsupported controls are 0. Throws
// Failure(kExitInternal) for an undefined vocabulary.
[[nodiscard]] std::vector<float> vocabulary_values(int vocabulary, const animation::Frame& frame);

}  // namespace mien::app
