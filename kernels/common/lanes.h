// Helpers for kernels that are written once for all tiers, as plain loops over the 8 channels of a
// block.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::kernels {
namespace {

inline constexpr int kBlockLanes = 8;

// Marks a loop whose iterations are independent, even where the compiler cannot prove it. The
// warning is off because sanitizers and low optimization levels legitimately prevent vectorization.
#ifdef __clang__
#pragma clang diagnostic ignored "-Wpass-failed"
#define MIEN_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define MIEN_INDEPENDENT _Pragma("GCC ivdep")
#endif

// Stores the first `lanes` values of a block and sets the others to zero.
[[maybe_unused]] inline void store_lanes(const float (&values)[kBlockLanes], std::int32_t lanes,
                                         float* y) {
  for (int i = 0; i < kBlockLanes; ++i) {
    y[i] = i < lanes ? values[i] : 0.0f;
  }
}

[[maybe_unused]] inline std::int32_t blocks_for(std::int32_t channels) {
  return (channels + kBlockLanes - 1) / kBlockLanes;
}

// Sets the unused lanes of a map's last block to zero.
[[maybe_unused]] inline void clear_unused_lanes(float* map, std::int32_t pixels,
                                                std::int32_t channels) {
  const std::int32_t used = channels % kBlockLanes;
  if (used == 0) {
    return;
  }
  float* block = map + std::ptrdiff_t{channels / kBlockLanes} * pixels * kBlockLanes;
  for (std::int32_t p = 0; p < pixels; ++p, block += kBlockLanes) {
    for (std::int32_t i = used; i < kBlockLanes; ++i) {
      block[i] = 0.0f;
    }
  }
}

}  // namespace
}  // namespace mien::kernels
