#include "apps/conformance/self_test.h"

#include <cstdio>

#include "apps/conformance/kernel_suite.h"
#include "apps/conformance/planted_faults.h"
#include "apps/conformance/terminal.h"

namespace mien::conformance {
namespace {

constexpr std::uint64_t kSeed = 1;

Finding found_in(const PlantedFault& planted) {
  // Any tier but the reference: results are compared with the reference's, too.
  const kernels::Entry entry{planted.family, kernels::Tier::kAvx2, planted.kernel};
  int cases = 0;
  return check_kernel(entry, kSeed, cases);
}

// Whether the checks said what they should.
bool report(const PlantedFault& planted) {
  const Colours& colour = colours();
  if (!planted.detectable) {
    std::printf("%-36s %s%-18s%s\n", planted.name, colour.faint, "not checked here", colour.end);
    return true;
  }
  const Finding finding = found_in(planted);
  const bool caught = finding.fault == planted.expected;
  std::printf("%-36s %s%-18s%s %s\n", planted.name, caught ? colour.good : colour.bad,
              name(finding.fault), colour.end,
              caught ? "" : (std::string("expected: ") + name(planted.expected)).c_str());
  return caught;
}

}  // namespace

int self_test() {
  int missed = 0;
  std::printf("%-36s %s\n", "planted", "noticed");
  for (const PlantedFault& planted : planted_faults()) {
    missed += report(planted) ? 0 : 1;
  }
  std::printf("%zu planted, %d missed\n", planted_faults().size(), missed);
  return missed;
}

}  // namespace mien::conformance
