// Measures the speed of kernels and networks, and the peak of the CPU.
#pragma once

#include <cstdint>
#include <functional>

#include "apps/conformance/report.h"
#include "kernels/registry.h"

namespace mien::conformance {

// Peak of fused multiply-adds in registers on one tier, in GFLOP/s; 0 if the tier has none.
[[nodiscard]] double peak_gflops(kernels::Tier tier);

// The minimum time of many calls of `work`, which performs `macs` multiply-accumulates.
[[nodiscard]] Timing timed(const std::function<void()>& work, std::uint64_t macs, double peak);

// Times the family's typical case. The kernel must have passed its checks.
[[nodiscard]] Timing time_kernel(const kernels::Entry& entry, double peak);

}  // namespace mien::conformance
