// Tiers: sets of kernels for one instruction set. The CPU mask has one bit per tier.
#pragma once

#include <cstdint>

namespace mien::kernels {

// Numbers are fixed: they are bits of the public CPU mask.
enum class Tier : std::uint32_t {
  kRef = 0,
  kAvx2 = 1,
  kAvx512 = 2,
  kNeon = 3,
  kNeonFp16 = 4,
  kNeon32 = 5,
  kWasm = 6,
};
inline constexpr std::uint32_t kTierCount = 7;

[[nodiscard]] constexpr std::uint32_t bit(Tier tier) {
  return 1u << static_cast<std::uint32_t>(tier);
}

// A bit of the CPU mask that is no tier: blocks of layers may run fused.
inline constexpr std::uint32_t kFusedBlocks = 1u << 31;

// A tier with all before it: what it lacks the best of these has.
[[nodiscard]] constexpr std::uint32_t up_to(Tier tier) { return 2 * bit(tier) - 1; }

// "ref", "avx2", ...
[[nodiscard]] const char* name(Tier tier);

// The tiers that this build has and this CPU can run; kRef is always among them, unless the build
// leaves it out (MIEN_TRIM_REF).
[[nodiscard]] std::uint32_t detect_cpu();

}  // namespace mien::kernels
