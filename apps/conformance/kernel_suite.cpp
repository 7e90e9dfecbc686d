// Checks kernels on random cases.
#include "apps/conformance/kernel_suite.h"

#include <algorithm>

namespace mien::conformance {
namespace {

kernels::AnyKernel reference_of(std::string_view family) {
  return kernels::find_any(family, kernels::bit(kernels::Tier::kRef));
}

std::string where(std::uint64_t seed, const RandomValues& random) {
  return "; seed " + std::to_string(seed) + ", case " + std::to_string(random.case_number()) +
         ", " + std::string(name(random.pattern()));
}

}  // namespace

const Arithmetic& arithmetic_of(kernels::Tier tier) {
  const bool has_int8 = kernels::has_int8(tier);
  if (kernels::is_quantized(tier)) {
    return has_int8 ? kInt8Arithmetic : kQuantizedArithmetic;
  }
  if (has_int8) {
    return kernels::int8_panel(tier) == 8 ? kHalfOrInt8MatrixArithmetic : kHalfOrInt8Arithmetic;
  }
  return kernels::is_half(tier) ? kHalfArithmetic : kSingleArithmetic;
}

Finding check_kernel(const kernels::Entry& entry, std::uint64_t seed, int& cases) {
  const Family* family = find_family(entry.family);
  if (family == nullptr) {
    return {Fault::kNoCases,
            "missing apps/conformance/families/" + std::string(entry.family) + ".cpp"};
  }
  const kernels::AnyKernel reference =
      entry.tier == kernels::Tier::kRef ? nullptr : reference_of(entry.family);
  double worst_share = 0.0;
  for (int number = 0; number < kCasesPerSeed; ++number, ++cases) {
    RandomValues random(seed, number, arithmetic_of(entry.tier));
    Finding finding = check(family->random_case(random), entry.function, reference);
    finding.worst_share = worst_share = std::max(worst_share, finding.worst_share);
    if (finding.fault != Fault::kNone) {
      finding.text += where(seed, random);
      return finding;
    }
  }
  return {Fault::kNone, "", worst_share};
}

bool has_all_references() {
  const auto entries = kernels::all_kernels();
  return std::all_of(entries.begin(), entries.end(), [](const kernels::Entry& entry) {
    return reference_of(entry.family) != nullptr;
  });
}

}  // namespace mien::conformance
