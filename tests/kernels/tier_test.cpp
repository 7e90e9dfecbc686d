// Tests of the detection of instruction sets.
#include "kernels/tier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "kernels/registry.h"

namespace mien::kernels {
namespace {

TEST(Tiers, PreferFixedPointToHalfPrecisionToFp32) {
  EXPECT_GT(rank(Tier::kAvx512Vnni), rank(Tier::kAvx512Fp16));
  EXPECT_GT(rank(Tier::kAvx512Fp16), rank(Tier::kAvx512));
  EXPECT_GT(rank(Tier::kAvx512), rank(Tier::kAvxVnni));
  EXPECT_GT(rank(Tier::kAvxVnni), rank(Tier::kAvx2Int16));
  EXPECT_GT(rank(Tier::kAvx2Int16), rank(Tier::kAvx2));
  EXPECT_GT(rank(Tier::kNeonFp16), rank(Tier::kNeon));
  EXPECT_GT(rank(Tier::kNeonDot), rank(Tier::kNeonFp16));
  EXPECT_GT(rank(Tier::kNeonI8mm), rank(Tier::kNeonDot));
}

#ifdef __x86_64__
bool is_compiled(Tier tier) {
  const std::span<const Entry> all = all_kernels();
  return std::any_of(all.begin(), all.end(), [=](const Entry& e) { return e.tier == tier; });
}

// The compiler's run-time library also detects the CPU's features.
TEST(Tiers, AreThoseThatTheRunTimeLibraryFinds) {
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("sse2")) {
    GTEST_SKIP()
        << "skipped: the run-time library reports no features, although every x86-64 CPU has some";
  }
  const std::uint32_t found = detect_cpu();
  const auto has = [&](Tier tier) { return (found & bit(tier)) != 0; };
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  EXPECT_EQ(has(Tier::kAvx2), avx2);
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") &&
                      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
                      __builtin_cpu_supports("avx512dq");
  if (is_compiled(Tier::kAvx512)) {
    EXPECT_EQ(has(Tier::kAvx512), avx512);
  }
  if (is_compiled(Tier::kAvx512Vnni)) {
    EXPECT_EQ(has(Tier::kAvx512Vnni), avx512 && __builtin_cpu_supports("avx512vnni"));
  }
  if (is_compiled(Tier::kAvx2Int16)) {
    EXPECT_EQ(has(Tier::kAvx2Int16), avx2);
  }
  EXPECT_TRUE(avx2 || !has(Tier::kAvxVnni));
  EXPECT_TRUE(avx512 || !has(Tier::kAvx512Fp16));
}
#endif

}  // namespace
}  // namespace mien::kernels
