// Kernel tiers by name.
#pragma once

#include <cstdint>
#include <string>

namespace mien::app {

// The CPU mask for `name`; all tiers when it is empty. The tiers before it stay allowed, so that a
// kernel that the tier lacks is still found. `unfused`: each layer by
// itself. Throws Failure when this CPU cannot run the tier.
std::uint32_t cpu_mask(const std::string& name, bool unfused = false);

}  // namespace mien::app
