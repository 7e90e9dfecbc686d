// Builds the table of kernels from kernels.inc and looks kernels up.
#include "kernels/registry.h"

#include "kernels/families.h"

namespace mien::kernels {
namespace {

// kernels.inc names tiers like namespaces; these constants map the names to Tier.
namespace tier_of {
constexpr Tier ref [[maybe_unused]] = Tier::kRef;
constexpr Tier avx2 [[maybe_unused]] = Tier::kAvx2;
constexpr Tier avx512 [[maybe_unused]] = Tier::kAvx512;
constexpr Tier neon [[maybe_unused]] = Tier::kNeon;
constexpr Tier neonfp16 [[maybe_unused]] = Tier::kNeonFp16;
constexpr Tier neondot [[maybe_unused]] = Tier::kNeonDot;
constexpr Tier neoni8mm [[maybe_unused]] = Tier::kNeonI8mm;
constexpr Tier neon32 [[maybe_unused]] = Tier::kNeon32;
constexpr Tier wasm [[maybe_unused]] = Tier::kWasm;
constexpr Tier avx512fp16 [[maybe_unused]] = Tier::kAvx512Fp16;
constexpr Tier avx512vnni [[maybe_unused]] = Tier::kAvx512Vnni;
constexpr Tier avx2int16 [[maybe_unused]] = Tier::kAvx2Int16;
constexpr Tier avxvnni [[maybe_unused]] = Tier::kAvxVnni;
constexpr Tier wasmint16 [[maybe_unused]] = Tier::kWasmInt16;
}  // namespace tier_of

const Entry* entries(std::size_t& count) {
#define MIEN_KERNEL(family, Args, tier) \
  {#family, tier_of::tier, reinterpret_cast<AnyKernel>(&tier::family)},
  static const Entry kEntries[] = {
#include "kernels/kernels.inc"
  };
#undef MIEN_KERNEL
  count = sizeof kEntries / sizeof kEntries[0];
  return kEntries;
}

}  // namespace

std::span<const Entry> all_kernels() {
  std::size_t count = 0;
  const Entry* first = entries(count);
  return {first, count};
}

const Entry* find_entry(std::string_view family, std::uint32_t cpu_mask) {
  const std::uint32_t usable = cpu_mask & detect_cpu();
  const Entry* best = nullptr;
  for (const Entry& entry : all_kernels()) {
    const bool allowed = (usable & bit(entry.tier)) != 0;
    if (allowed && entry.family == family &&
        (best == nullptr || rank(entry.tier) > rank(best->tier))) {
      best = &entry;
    }
  }
  return best;
}

AnyKernel find_any(std::string_view family, std::uint32_t cpu_mask) {
  const Entry* best = find_entry(family, cpu_mask);
  return best == nullptr ? nullptr : best->function;
}

}  // namespace mien::kernels
