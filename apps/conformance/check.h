// Runs one case on a kernel and says what is wrong with it.
#pragma once

#include <cstdint>
#include <string>

#include "apps/conformance/case.h"

namespace mien::conformance {

enum class Fault : std::uint8_t {
  kNone,
  kWrongResult,       // beyond the bound of the double reference
  kDiffersFromRef,    // beyond both bounds of the reference kernel
  kTouchesBorder,     // writes beside a buffer
  kChangesInput,      // writes to a buffer it may only read
  kClobbersRegister,  // does not preserve what the calling convention asks for
  kCrashes,           // among them: reads or writes beyond a guard page
  kNoCases,           // a kernel of a family that has no cases here
};
[[nodiscard]] const char* name(Fault fault);  // "wrong result"

struct Finding {
  Fault fault = Fault::kNone;
  std::string text;          // the first thing that is wrong: where, what instead of what
  double worst_share = 0.0;  // of the bound, the largest error of all
};

// `reference`: nullptr, or the family's reference kernel, whose results are compared, too.
[[nodiscard]] Finding check(const Case& test, kernels::AnyKernel kernel,
                            kernels::AnyKernel reference);

}  // namespace mien::conformance
