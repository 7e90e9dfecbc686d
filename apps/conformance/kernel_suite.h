// Kernels of the registry, each on many cases.
#pragma once

#include <cstdint>

#include "apps/conformance/check.h"
#include "kernels/registry.h"

namespace mien::conformance {

inline constexpr int kCasesPerSeed = 40;

// How kernels of a tier may count where their family allows for less than fp32.
[[nodiscard]] const Arithmetic& arithmetic_of(kernels::Tier tier);

// The cases of one seed; stops at the first that is not right. `cases` counts on.
[[nodiscard]] Finding check_kernel(const kernels::Entry& entry, std::uint64_t seed, int& cases);

// Whether the registry has a reference kernel for every family: without, there is nothing to hold
// the others against.
[[nodiscard]] bool has_all_references();

}  // namespace mien::conformance
