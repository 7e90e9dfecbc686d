// How fast a kernel or a network is, and how fast it could be.
#pragma once

#include <cstdint>
#include <functional>

#include "apps/conformance/report.h"
#include "kernels/registry.h"

namespace mien::conformance {

// Of a loop of fused multiply-adds in registers on one tier, in GFLOP/s; 0 if the tier has none.
[[nodiscard]] double peak_gflops(kernels::Tier tier);

// The least time of many calls of `work`, which does `macs` multiply-accumulates.
[[nodiscard]] Timing timed(const std::function<void()>& work, std::uint64_t macs, double peak);

// Of the family's typical case. The kernel is known to work.
[[nodiscard]] Timing time_kernel(const kernels::Entry& entry, double peak);

}  // namespace mien::conformance
