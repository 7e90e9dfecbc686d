// Runs as many fused multiply-adds as the tier can, in registers only: the peak with which
// benchmarks compare. y receives sums that depend on all of them, so that none is optimized away.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct FmaPeakArgs {
  static constexpr std::string_view kFamily = "fma_peak";
  float* y;  // [8]
  std::int64_t rounds;
  std::int64_t* macs;  // receives the number of multiply-adds
};

}  // namespace mien::kernels
