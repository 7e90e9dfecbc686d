// Kernels that are wrong on purpose, with the fault that the checks must report for each.
#pragma once

#include <span>

#include "apps/conformance/check.h"

namespace mien::conformance {

struct FaultyKernel {
  const char* name;  // "writes one element past the end"
  const char* family;
  kernels::AnyKernel kernel;
  Fault expected;
  bool detectable;  // false without the required guard pages, signals or register check
  kernels::Tier tier = kernels::Tier::kAvx2;  // that it stands for; any other than the reference
};

// Includes a correct kernel, with kNone as the expected fault.
[[nodiscard]] std::span<const FaultyKernel> faulty_kernels();

}  // namespace mien::conformance
