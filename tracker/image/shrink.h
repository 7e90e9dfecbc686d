// Downscaling of network inputs.
#pragma once

#include <cstdint>
#include <span>

namespace mien::tracker {

// Downscales a square RGB image [from][from][3] to [to][to][3], to <= from: each pixel is the mean
// of the area that it covers. `scratch`: at least [from][3].
void shrink(std::span<const float> image, std::int32_t from, std::span<float> smaller,
            std::int32_t to, std::span<float> scratch);

}  // namespace mien::tracker
