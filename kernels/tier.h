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
  kAvx512Fp16 = 7,
  kAvx512Vnni = 8,
};
inline constexpr std::uint32_t kTierCount = 9;

[[nodiscard]] constexpr std::uint32_t bit(Tier tier) {
  return 1u << static_cast<std::uint32_t>(tier);
}

// The tiers that compute in half precision where it pays: in fp16, where values beyond 65504 become
// infinite, or in fixed point.
inline constexpr std::uint32_t kHalfTiers =
    bit(Tier::kNeonFp16) | bit(Tier::kAvx512Fp16) | bit(Tier::kAvx512Vnni);
[[nodiscard]] constexpr bool is_half(Tier tier) { return (kHalfTiers & bit(tier)) != 0; }

// A bit of the CPU mask that is no tier: blocks of layers may run fused.
inline constexpr std::uint32_t kFusedBlocks = 1u << 31;

// Greater for the better of two tiers. In number kAvx512Vnni is the last, but every CPU with
// AVX-512 FP16 has it, too.
[[nodiscard]] constexpr std::uint32_t rank(Tier tier) {
  return tier == Tier::kAvx512Vnni ? 2 * static_cast<std::uint32_t>(Tier::kAvx512) + 1
                                   : 2 * static_cast<std::uint32_t>(tier);
}

// A tier with all of lesser rank: what it lacks the best of these has.
[[nodiscard]] constexpr std::uint32_t up_to(Tier tier) {
  std::uint32_t mask = 0;
  for (std::uint32_t i = 0; i < kTierCount; ++i) {
    const auto one = static_cast<Tier>(i);
    mask |= rank(one) <= rank(tier) ? bit(one) : 0;
  }
  return mask;
}

// "ref", "avx2", ...
[[nodiscard]] const char* name(Tier tier);

// The tiers that this build has and this CPU can run; kRef is always among them, unless the build
// leaves it out (MIEN_TRIM_REF).
[[nodiscard]] std::uint32_t detect_cpu();

}  // namespace mien::kernels
