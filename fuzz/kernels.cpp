// The bytes choose a kernel and its arguments. The kernel is compared with the reference kernel, in
// memory between guard pages. An empty input runs all kernels, so that one file of the corpus
// covers future kernels as well.
#include <algorithm>
#include <cstdio>

#include "apps/conformance/check.h"
#include "apps/conformance/kernel_suite.h"
#include "fuzz/bytes.h"
#include "fuzz/target.h"

namespace {

using namespace mien;

void check(const kernels::Entry& entry, std::uint64_t seed, int number,
           std::span<const std::uint8_t> choices) {
  const conformance::Family* family = conformance::find_family(entry.family);
  if ((kernels::detect_cpu() & kernels::bit(entry.tier)) == 0 || family == nullptr) {
    return;
  }
  conformance::RandomValues random(seed, number, conformance::arithmetic_of(entry.tier));
  random.choose_first(choices);
  const kernels::AnyKernel reference =
      entry.tier == kernels::Tier::kRef
          ? nullptr
          : kernels::find_any(entry.family, kernels::bit(kernels::Tier::kRef));
  const conformance::Case test = family->random_case(random);
  const conformance::Finding finding = conformance::check(test, entry.function, reference);
  if (finding.fault != conformance::Fault::kNone) {
    std::fprintf(stderr, "%s, %s: %s: %s\n", std::string(entry.family).c_str(), test.shape.c_str(),
                 conformance::name(finding.fault), finding.text.c_str());
    fuzz::require(false);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto kernels = kernels::all_kernels();
  if (size == 0) {
    for (const kernels::Entry& entry : kernels) {
      for (int number = 0; number < conformance::kPatternCount; ++number) {
        check(entry, 1, number, {});
      }
    }
    return 0;
  }
  fuzz::Bytes choices(data, size);
  const kernels::Entry& entry = kernels[choices.take<std::uint8_t>() % kernels.size()];
  const int number = choices.between(0, 255);
  const auto seed = choices.take<std::uint16_t>();
  check(entry, seed, number,
        choices.rest().first(std::min<std::size_t>(choices.rest().size(), 12)));
  return 0;
}
