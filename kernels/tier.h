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
  kAvx2Int16 = 9,
  kAvxVnni = 10,
  kWasmInt16 = 11,
  kNeonDot = 12,
  kNeonI8mm = 13,
};
inline constexpr std::uint32_t kTierCount = 14;

[[nodiscard]] constexpr std::uint32_t bit(Tier tier) {
  return 1u << static_cast<std::uint32_t>(tier);
}

// Tiers that multiply 16-bit integers in fused blocks.
inline constexpr std::uint32_t kQuantizedTiers =
    bit(Tier::kAvx512Vnni) | bit(Tier::kAvx2Int16) | bit(Tier::kAvxVnni) | bit(Tier::kWasmInt16);
[[nodiscard]] constexpr bool is_quantized(Tier tier) { return (kQuantizedTiers & bit(tier)) != 0; }

// Tiers that multiply 8-bit integers there.
inline constexpr std::uint32_t kInt8Tiers =
    bit(Tier::kAvx512Vnni) | bit(Tier::kAvxVnni) | bit(Tier::kNeonDot) | bit(Tier::kNeonI8mm);
[[nodiscard]] constexpr bool has_int8(Tier tier) { return (kInt8Tiers & bit(tier)) != 0; }

// Outputs of a panel of their weights (quantize_to_int8.h).
[[nodiscard]] constexpr std::int32_t int8_panel(Tier tier) {
  return tier == Tier::kNeonI8mm ? 8 : 16;
}

// Tiers that use half precision in fused blocks: fp16, where values beyond 65504 become infinite,
// or quantized integers.
inline constexpr std::uint32_t kHalfTiers =
    bit(Tier::kNeonFp16) | bit(Tier::kAvx512Fp16) | kQuantizedTiers | kInt8Tiers;
[[nodiscard]] constexpr bool is_half(Tier tier) { return (kHalfTiers & bit(tier)) != 0; }

// The bit of the CPU mask that allows fused blocks; it is not a tier.
inline constexpr std::uint32_t kFusedBlocks = 1u << 31;

// Greater for the better of two tiers. Values are in order of publication; the half-precision tiers
// of x86, kNeonDot and kNeonI8mm rank just above the tier that they extend. kAvx512Vnni ranks above
// kAvx512Fp16, because it is faster and more accurate on CPUs with both.
[[nodiscard]] constexpr std::uint32_t rank(Tier tier) {
  const auto above = [](Tier base, std::uint32_t steps) {
    return 4 * static_cast<std::uint32_t>(base) + steps;
  };
  return tier == Tier::kAvx2Int16    ? above(Tier::kAvx2, 1)
         : tier == Tier::kAvxVnni    ? above(Tier::kAvx2, 2)
         : tier == Tier::kAvx512Fp16 ? above(Tier::kAvx512, 1)
         : tier == Tier::kAvx512Vnni ? above(Tier::kAvx512, 2)
         : tier == Tier::kNeonDot    ? above(Tier::kNeonFp16, 1)
         : tier == Tier::kNeonI8mm   ? above(Tier::kNeonFp16, 2)
         : tier == Tier::kWasmInt16  ? above(Tier::kWasm, 1)
                                     : above(tier, 0);
}

// A tier and all fp32 tiers of lower rank, which supply the kernels that the tier lacks.
[[nodiscard]] constexpr std::uint32_t up_to(Tier tier) {
  std::uint32_t mask = bit(tier);
  for (std::uint32_t i = 0; i < kTierCount; ++i) {
    const auto one = static_cast<Tier>(i);
    mask |= rank(one) < rank(tier) && !is_half(one) ? bit(one) : 0;
  }
  return mask;
}

// The tier's name: "ref", "avx2", ...
[[nodiscard]] const char* name(Tier tier);

// The tiers of this build that this CPU supports; always with kRef, unless MIEN_TRIM_REF excludes
// it.
[[nodiscard]] std::uint32_t detect_cpu();

}  // namespace mien::kernels
