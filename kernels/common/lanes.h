// What kernels share that are written once for all tiers, as plain loops over the 8 channels of a
// block.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::kernels {
namespace {

inline constexpr int kBlockLanes = 8;

// Before a loop whose iterations do not depend on one another, whatever the compiler can prove.
// clang warns where sanitizers or the optimization level keep it from making vectors, which is no
// fault.
#ifdef __clang__
#pragma clang diagnostic ignored "-Wpass-failed"
#define MIEN_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define MIEN_INDEPENDENT _Pragma("GCC ivdep")
#endif

// Channels of a block that exist; the others become zero.
[[maybe_unused]] inline void store_lanes(const float (&values)[kBlockLanes], std::int32_t lanes,
                                         float* y) {
  for (int i = 0; i < kBlockLanes; ++i) {
    y[i] = i < lanes ? values[i] : 0.0f;
  }
}

[[maybe_unused]] inline std::int32_t blocks_for(std::int32_t channels) {
  return (channels + kBlockLanes - 1) / kBlockLanes;
}

// In the last block of a map.
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
