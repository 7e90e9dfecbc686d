// Lists every kernel in this build, from kernels.inc, for dispatch, conformance tests and
// benchmarks.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "kernels/tier.h"

namespace mien::kernels {

// A kernel receives its family's argument struct, which has the family's name (Args::kFamily).
template <class Args>
using Kernel = void (*)(const Args&);

using AnyKernel = void (*)();

struct Entry {
  std::string_view family;
  Tier tier;
  AnyKernel function;
};

[[nodiscard]] std::span<const Entry> all_kernels();

// The best kernel of a family among the tiers of `cpu_mask` that this CPU supports; else nullptr.
[[nodiscard]] const Entry* find_entry(std::string_view family, std::uint32_t cpu_mask);
[[nodiscard]] AnyKernel find_any(std::string_view family, std::uint32_t cpu_mask);

template <class Args>
[[nodiscard]] Kernel<Args> find(std::uint32_t cpu_mask) {
  return reinterpret_cast<Kernel<Args>>(find_any(Args::kFamily, cpu_mask));
}

}  // namespace mien::kernels
