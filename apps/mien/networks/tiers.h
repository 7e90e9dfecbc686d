// Kernel tiers by name.
#pragma once

#include <cstdint>
#include <string>

namespace mien::app {

// The CPU mask for the tier `name`, or for all tiers if it is empty. Lower tiers stay enabled for
// kernels that the tier lacks. `unfused` runs networks layer by layer. Throws Failure if this CPU
// cannot run the tier.
std::uint32_t cpu_mask(const std::string& name, bool unfused = false);

}  // namespace mien::app
