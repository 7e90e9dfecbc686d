// As many fused multiply-adds as the tier can do, on registers alone: what a benchmark holds its
// figures against. y receives sums that depend on all of them, so that none can be left out.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

struct FmaPeakArgs {
  static constexpr std::string_view kFamily = "fma_peak";
  float* y;  // [8]
  std::int64_t rounds;
  std::int64_t* macs;  // receives the number of multiply-adds done
};

}  // namespace mien::kernels
