// Checks the faulty kernels and reports misses.
#include "apps/conformance/self_test.h"

#include <cstdio>

#include "apps/conformance/faulty_kernels.h"
#include "apps/conformance/kernel_suite.h"
#include "apps/conformance/terminal.h"

namespace mien::conformance {
namespace {

constexpr std::uint64_t kSeed = 1;

Finding found_in(const FaultyKernel& faulty) {
  const kernels::Entry entry{faulty.family, faulty.tier, faulty.kernel};
  int cases = 0;
  return check_kernel(entry, kSeed, cases);
}

// Whether the checks report the expected fault.
bool report(const FaultyKernel& faulty) {
  const Colours& colour = colours();
  if (!faulty.detectable) {
    std::printf("%-36s %s%-18s%s\n", faulty.name, colour.faint, "not supported here", colour.end);
    return true;
  }
  const Finding finding = found_in(faulty);
  const bool caught = finding.fault == faulty.expected;
  std::printf("%-36s %s%-18s%s %s\n", faulty.name, caught ? colour.good : colour.bad,
              name(finding.fault), colour.end,
              caught ? "" : (std::string("expected: ") + name(faulty.expected)).c_str());
  return caught;
}

}  // namespace

int self_test() {
  int missed = 0;
  std::printf("%-36s %s\n", "kernel", "result");
  for (const FaultyKernel& faulty : faulty_kernels()) {
    missed += report(faulty) ? 0 : 1;
  }
  std::printf("%zu faulty kernels, %d missed\n", faulty_kernels().size(), missed);
  return missed;
}

}  // namespace mien::conformance
