// Runs every kernel of every tier of this CPU on the cases of apps/conformance.
#include <gtest/gtest.h>

#include "apps/conformance/kernel_suite.h"

namespace mien::tests {
namespace {

using namespace conformance;  // NOLINT: the test is about nothing else

constexpr std::uint64_t kSeeds = 3;

std::vector<kernels::Entry> kernels_here() {
  std::vector<kernels::Entry> here;
  for (const kernels::Entry& entry : kernels::all_kernels()) {
    if ((kernels::detect_cpu() & kernels::bit(entry.tier)) != 0) {
      here.push_back(entry);
    }
  }
  return here;
}

class Conformance : public testing::TestWithParam<kernels::Entry> {};

TEST_P(Conformance, EveryCase) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    int cases = 0;
    const Finding finding = check_kernel(GetParam(), seed, cases);
    ASSERT_EQ(finding.fault, Fault::kNone) << name(finding.fault) << ": " << finding.text;
    EXPECT_EQ(cases, kCasesPerSeed);
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, Conformance, testing::ValuesIn(kernels_here()),
                         [](const auto& test) {
                           return std::string(test.param.family) + "_" +
                                  kernels::name(test.param.tier);
                         });

}  // namespace
}  // namespace mien::tests
