// The checks of apps/conformance detect faulty kernels, and accept correct ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/conformance/crash_guard.h"
#include "apps/conformance/faulty_kernels.h"
#include "apps/conformance/guarded_buffer.h"
#include "apps/conformance/kernel_suite.h"

namespace mien::tests {
namespace {

using namespace conformance;  // NOLINT: the test is about nothing else
using testing::HasSubstr;

class Faulty : public testing::TestWithParam<FaultyKernel> {};

TEST_P(Faulty, IsNoticedWithOtherSeedsToo) {
  if (!GetParam().detectable) {
    GTEST_SKIP() << "cannot be detected on this system";
  }
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    int cases = 0;
    const kernels::Entry entry{GetParam().family, GetParam().tier, GetParam().kernel};
    const Finding finding = check_kernel(entry, seed, cases);
    EXPECT_EQ(finding.fault, GetParam().expected) << finding.text;
  }
}

INSTANTIATE_TEST_SUITE_P(Faults, Faulty,
                         testing::ValuesIn(faulty_kernels().begin(), faulty_kernels().end()),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           for (char& one : name) {
                             one = std::isalnum(static_cast<unsigned char>(one)) ? one : '_';
                           }
                           return name;
                         });

void wrong_here(const kernels::ResidualAddArgs& a) {
  kernels::ref::residual_add(a);
  a.y[5] += 100.0f;
}

TEST(Check, SaysWhere) {
  RandomValues random(1, 0);
  const Case test = random_case<kernels::ResidualAddArgs>(random);
  const Finding finding = check(test, reinterpret_cast<kernels::AnyKernel>(wrong_here), nullptr);
  EXPECT_EQ(finding.fault, Fault::kWrongResult);
  EXPECT_THAT(finding.text, HasSubstr("element 5: "));
  EXPECT_THAT(finding.text, HasSubstr(test.shape));
}

// A reference kernel whose error exceeds its bound shows as a difference between the two.
void off_by_two_bounds(const kernels::ResidualAddArgs& a) {
  kernels::ref::residual_add(a);
  a.y[0] = std::nextafter(std::nextafter(std::nextafter(a.y[0], 1e9f), 1e9f), 1e9f);
}

TEST(Check, ComparesWithTheReferenceToo) {
  RandomValues random(3, 0);
  const Case test = random_case<kernels::ResidualAddArgs>(random);
  const Finding finding =
      check(test, reinterpret_cast<kernels::AnyKernel>(kernels::ref::residual_add),
            reinterpret_cast<kernels::AnyKernel>(off_by_two_bounds));
  EXPECT_EQ(finding.fault, Fault::kDiffersFromRef) << finding.text;
}

TEST(KernelSuite, AFamilyWithoutCasesIsAFailure) {
  int cases = 0;
  const kernels::Entry entry{"unheard_of", kernels::Tier::kRef, nullptr};
  EXPECT_EQ(check_kernel(entry, 1, cases).fault, Fault::kNoCases);
}

TEST(CrashGuard, ComesBackFromOneCrashAfterAnother) {
  if (!can_catch_crashes()) {
    GTEST_SKIP() << "no signals on this system";
  }
  int runs = 0;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NE(run_guarded([](void*) { __builtin_trap(); }, nullptr), nullptr);
    EXPECT_EQ(run_guarded([](void* count) { ++*static_cast<int*>(count); }, &runs), nullptr);
  }
  EXPECT_EQ(runs, 3);
}

TEST(GuardedBuffer, BordersAreOnBothSides) {
  const std::vector<std::byte> content(24, std::byte{1});
  GuardedBuffer buffer(content, 4, Placement::kUnaligned);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.data()) % 64, 4u);
  EXPECT_TRUE(buffer.border_intact());
  for (const int at : {-1, 24, -68, 200}) {
    const std::byte before = buffer.data()[at];
    EXPECT_EQ(before, std::byte{0xAA});
    buffer.data()[at] = std::byte{0};
    EXPECT_FALSE(buffer.border_intact()) << at;
    buffer.data()[at] = before;
  }
}

}  // namespace
}  // namespace mien::tests
