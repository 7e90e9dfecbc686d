// Checks kernels of the registry on many cases.
#pragma once

#include <cstdint>

#include "apps/conformance/check.h"
#include "kernels/registry.h"

namespace mien::conformance {

inline constexpr int kCasesPerSeed = 40;

// The arithmetic that kernels of a tier may use in families that allow less precision than fp32.
[[nodiscard]] const Arithmetic& arithmetic_of(kernels::Tier tier);

// Checks the cases of one seed, up to the first failure. Adds their number to `cases`.
[[nodiscard]] Finding check_kernel(const kernels::Entry& entry, std::uint64_t seed, int& cases);

// Whether the registry has a reference kernel for every family, which the other tiers need.
[[nodiscard]] bool has_all_references();

}  // namespace mien::conformance
