// Selects kernel tiers by name.
#include "apps/mien/networks/tiers.h"

#include <mien/mien.h>

#include "apps/mien/system/failure.h"

namespace mien::app {

std::uint32_t cpu_mask(const std::string& name, bool unfused) {
  const std::uint32_t fused = unfused ? 0 : MIEN_CPU_FUSED;
  if (name.empty()) {
    return (MIEN_CPU_ALL & ~MIEN_CPU_FUSED) | fused;
  }
  for (std::uint32_t tier = 1; tier != 0; tier <<= 1) {
    const char* known = mien_cpu_tier_name(tier);
    if (known == nullptr || name != known) {
      continue;
    }
    if ((mien_cpu_tiers() & tier) == 0) {
      throw Failure(kExitUnsupportedTier,
                    "--tier: '" + name + "' is not available on this CPU or not compiled in");
    }
    return (2 * tier - 1) | fused;
  }
  throw Failure(kExitUsage, "--tier: unknown tier '" + name + "'");
}

}  // namespace mien::app
