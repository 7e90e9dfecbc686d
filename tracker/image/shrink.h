// Making pictures smaller.
#pragma once

#include <cstdint>
#include <span>

namespace mien::tracker {

// Square RGB picture [from][from][3] to [to][to][3], to <= from: every pixel becomes the mean of
// the area that it covers. `scratch`: [from][3] at least.
void shrink(std::span<const float> picture, std::int32_t from, std::span<float> smaller,
            std::int32_t to, std::span<float> scratch);

}  // namespace mien::tracker
