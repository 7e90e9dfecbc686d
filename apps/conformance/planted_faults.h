// Kernels that are wrong on purpose, and what the checks should say about each.
#pragma once

#include <span>

#include "apps/conformance/check.h"

namespace mien::conformance {

struct PlantedFault {
  const char* name;  // "writes one element past the end"
  const char* family;
  kernels::AnyKernel kernel;
  Fault expected;
  bool detectable;  // on this system: it may have no guard pages, signals or register check
};

// kNone is among what is expected: a kernel that is right must be let through.
[[nodiscard]] std::span<const PlantedFault> planted_faults();

}  // namespace mien::conformance
