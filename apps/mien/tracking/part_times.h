// Times of the tracker's parts in the words of users.
#pragma once

#include <mien/mien.h>

#include <array>
#include <string>

namespace mien::app {

using StageMs = std::array<double, MIEN_STAGE_COUNT>;

// "0.31 ms per frame: detection 0.02, face 0.20, audio 0.09"
[[nodiscard]] std::string part_times(const StageMs& mean, int decimals);

}  // namespace mien::app
