// CPU masks of the tiers of this CPU, each with the tiers before it, which provide the kernels that
// it lacks.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/tier.h"

namespace mien::tests {

inline std::vector<std::uint32_t> every_tier() {
  std::vector<std::uint32_t> masks;
  for (std::uint32_t tier = 0; tier < kernels::kTierCount; ++tier) {
    if ((kernels::detect_cpu() & 1u << tier) != 0) {
      masks.push_back(kernels::up_to(static_cast<kernels::Tier>(tier)));
    }
  }
  return masks;
}

// Whether the kernels of a mask may include some that compute in half precision.
inline bool is_half(std::uint32_t cpu_mask) {
  return (cpu_mask & kernels::detect_cpu() & kernels::kHalfTiers) != 0;
}

}  // namespace mien::tests
