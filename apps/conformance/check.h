// Runs one case on a kernel and reports the first fault.
#pragma once

#include <cstdint>
#include <string>

#include "apps/conformance/case.h"

namespace mien::conformance {

enum class Fault : std::uint8_t {
  kNone,
  kWrongResult,       // outside the bound around the double-precision reference
  kDiffersFromRef,    // outside twice the bound around the reference kernel
  kTouchesBorder,     // writes outside a buffer
  kChangesInput,      // writes to a read-only buffer
  kClobbersRegister,  // does not preserve a register that the calling convention requires
  kCrashes,           // also on access beyond a guard page
  kNoCases,           // the kernel's family has no cases
};
[[nodiscard]] const char* name(Fault fault);  // "wrong result"

struct Finding {
  Fault fault = Fault::kNone;
  std::string text;          // the first fault: location, actual and expected value
  double worst_share = 0.0;  // largest error relative to its bound
};

// `reference`: the family's reference kernel, to compare with as well, or nullptr.
[[nodiscard]] Finding check(const Case& test, kernels::AnyKernel kernel,
                            kernels::AnyKernel reference);

}  // namespace mien::conformance
