// The morph targets of an avatar that animations move.
#pragma once

#include <vector>

#include "apps/mien/avatar/avatar.h"

namespace mien::app {

// Finds them by the expressions of a VRM, or by the names of targets. Throws Json::exception if
// meshes or expressions are malformed.
[[nodiscard]] std::vector<MorphNode> find_morphs(const Json& document);

}  // namespace mien::app
