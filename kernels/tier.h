// Tiers: the kernels for one set of CPU instructions each. The CPU mask has one bit per tier.
#pragma once

#include <cstdint>

namespace mien::kernels {

// The values are fixed, because they are bits of the public CPU mask.
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

// Tiers that use half precision in fused blocks: fp16, where values beyond 65504 become infinite,
// or quantized integers.
inline constexpr std::uint32_t kHalfTiers =
    bit(Tier::kNeonFp16) | bit(Tier::kAvx512Fp16) | bit(Tier::kAvx512Vnni);
[[nodiscard]] constexpr bool is_half(Tier tier) { return (kHalfTiers & bit(tier)) != 0; }

// The bit of the CPU mask that allows fused blocks; it is not a tier.
inline constexpr std::uint32_t kFusedBlocks = 1u << 31;

// Greater for the better of two tiers. kAvx512Vnni has the largest value but ranks below
// kAvx512Fp16, because every CPU with AVX-512 FP16 also has VNNI.
[[nodiscard]] constexpr std::uint32_t rank(Tier tier) {
  return tier == Tier::kAvx512Vnni ? 2 * static_cast<std::uint32_t>(Tier::kAvx512) + 1
                                   : 2 * static_cast<std::uint32_t>(tier);
}

// A tier and all tiers of lower rank, which supply the kernels that the tier lacks.
[[nodiscard]] constexpr std::uint32_t up_to(Tier tier) {
  std::uint32_t mask = 0;
  for (std::uint32_t i = 0; i < kTierCount; ++i) {
    const auto one = static_cast<Tier>(i);
    mask |= rank(one) <= rank(tier) ? bit(one) : 0;
  }
  return mask;
}

// The tier's name: "ref", "avx2", ...
[[nodiscard]] const char* name(Tier tier);

// The tiers of this build that this CPU supports; always with kRef, unless MIEN_TRIM_REF excludes
// it.
[[nodiscard]] std::uint32_t detect_cpu();

}  // namespace mien::kernels
