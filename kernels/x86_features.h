// Detects the instruction sets of an x86-64 CPU whose registers the operating system saves.
// Source: Intel SDM, volume 1, 14.3 and 15.2 to 15.4, and volume 2, CPUID and XGETBV.
//
// __builtin_cpu_supports is not enough: older compilers do not know all features (clang 14 lacks
// F16C and AVX-512 FP16), and Zig's run-time library reports none.
#pragma once

#include <cpuid.h>

#include <cstdint>

namespace mien::kernels {

struct X86Features {
  bool avx2 = false;        // also FMA and F16C
  bool avx512 = false;      // F, BW, DQ, VL, and avx2
  bool avx512fp16 = false;  // implies avx512
  bool avx512vnni = false;  // implies avx512
  bool avxvnni = false;     // implies avx2
};

// The register sets that the operating system saves. Requires OSXSAVE. Inline assembly, because the
// intrinsic requires a compiler option.
inline std::uint32_t x86_saved_registers() {
  std::uint32_t low = 0, high = 0;
  __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return low;
}

template <class... Bits>
constexpr bool all_set(std::uint32_t word, Bits... bits) {
  return ((word >> bits & 1u) & ...) != 0;
}

inline X86Features x86_features() {
  constexpr std::uint32_t kVectors = 0x6;  // SSE, AVX
#ifdef __APPLE__  // saves the rest from a thread's first use on, and only then reports it
  constexpr std::uint32_t kAllVectors = kVectors;
#else
  constexpr std::uint32_t kAllVectors = 0xe6;  // also masks and upper halves
#endif
  std::uint32_t eax = 0, ebx = 0, ecx = 0, edx = 0;
  X86Features features;
  const bool known = __get_cpuid(1, &eax, &ebx, &ecx, &edx) != 0;
  if (!known || !all_set(ecx, 12, 27, 28, 29)) {  // FMA, OSXSAVE, AVX, F16C
    return features;
  }
  const std::uint32_t saved = x86_saved_registers();
  if ((saved & kVectors) != kVectors || __get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) == 0) {
    return features;
  }
  features.avx2 = all_set(ebx, 5);
  const bool saves_all = (saved & kAllVectors) == kAllVectors;
  features.avx512 = features.avx2 && saves_all && all_set(ebx, 16, 17, 30, 31);  // F, DQ, BW, VL
  features.avx512fp16 = features.avx512 && all_set(edx, 23);
  features.avx512vnni = features.avx512 && all_set(ecx, 11);
  const bool has_subleaf = eax >= 1 && __get_cpuid_count(7, 1, &eax, &ebx, &ecx, &edx) != 0;
  features.avxvnni = features.avx2 && has_subleaf && all_set(eax, 4);
  return features;
}

}  // namespace mien::kernels
