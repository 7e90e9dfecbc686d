// Selects kernel tiers by name.
#include "apps/mien/networks/tiers.h"

#include <mien/mien.h>

#include "apps/mien/system/failure.h"

namespace mien::app {

namespace {

// The fp32 tiers that supply the kernels that `tier` lacks.
std::uint32_t below(std::uint32_t tier) {
  const bool extends_avx2 = tier == MIEN_CPU_AVX2_INT16 || tier == MIEN_CPU_AVX_VNNI;
  return extends_avx2 ? MIEN_CPU_REF | MIEN_CPU_AVX2 : (tier - 1) & ~MIEN_CPU_HALF;
}

}  // namespace

std::uint32_t cpu_mask(const std::string& name, bool unfused) {
  const std::uint32_t fused = unfused ? 0 : MIEN_CPU_FUSED;
  if (name.empty()) {
    return (MIEN_CPU_ALL & ~MIEN_CPU_FUSED) | fused;
  }
  std::string names;
  for (std::uint32_t tier = 1; tier != 0; tier <<= 1) {
    const char* known = mien_cpu_tier_name(tier);
    if (known == nullptr) {
      continue;
    }
    if (name != known) {
      names.append(" ").append(known);
      continue;
    }
    if ((mien_cpu_tiers() & tier) == 0) {
      throw Failure(kExitUnsupportedTier,
                    "--tier: '" + name + "' is not available on this CPU or not compiled in");
    }
    return tier | below(tier) | fused;
  }
  throw Failure(kExitUsage,
                "--tier: unknown tier (got '" + name + "', expected one of" + names + ")");
}

}  // namespace mien::app
