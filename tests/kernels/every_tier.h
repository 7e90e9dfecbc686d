// CPU masks of one tier each, of all there are: tests skip those that this CPU lacks.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/tier.h"

namespace mien::tests {

inline std::vector<std::uint32_t> every_tier() {
  std::vector<std::uint32_t> masks;
  for (std::uint32_t tier = 0; tier < kernels::kTierCount; ++tier) {
    masks.push_back(kernels::bit(static_cast<kernels::Tier>(tier)));
  }
  return masks;
}

}  // namespace mien::tests
