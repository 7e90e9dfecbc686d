#include "kernels/registry.h"

#include "kernels/families.h"

namespace mien::kernels {
namespace {

// kernels.inc spells tiers as namespaces; these names turn them into numbers.
namespace tier_of {
constexpr Tier ref = Tier::kRef;
constexpr Tier avx2 [[maybe_unused]] = Tier::kAvx2;
constexpr Tier avx512 [[maybe_unused]] = Tier::kAvx512;
constexpr Tier neon [[maybe_unused]] = Tier::kNeon;
constexpr Tier neon32 [[maybe_unused]] = Tier::kNeon32;
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

AnyKernel find_any(std::string_view family, std::uint32_t cpu_mask) {
  const std::uint32_t usable = cpu_mask & detect_cpu();
  AnyKernel best = nullptr;
  Tier best_tier = Tier::kRef;
  for (const Entry& entry : all_kernels()) {
    const bool allowed = (usable & bit(entry.tier)) != 0;
    if (allowed && entry.family == family && (best == nullptr || entry.tier > best_tier)) {
      best = entry.function;
      best_tier = entry.tier;
    }
  }
  return best;
}

}  // namespace mien::kernels
