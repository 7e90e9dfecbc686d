// What this x86-64 CPU has of what tiers need, and its system saves when threads take turns.
// Source: Intel SDM, volume 1, 14.3 and 15.2 to 15.4, and volume 2, CPUID and XGETBV.
//
// Compilers have __builtin_cpu_supports, which asks their run-time library, and knows less the
// older they are: clang 14 nothing of F16C and of AVX-512 FP16. In Zig's it says no to everything.
#pragma once

#include <cpuid.h>

#include <cstdint>

namespace mien::kernels {

struct X86Features {
  bool avx2 = false;        // and FMA, F16C
  bool avx512 = false;      // F, BW, DQ, VL, and avx2
  bool avx512fp16 = false;  // and avx512, as the next
  bool avx512vnni = false;
};

// The registers that the system saves; only where CPUID has OSXSAVE. The instruction itself, since
// intrinsics for it want options of the compiler.
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
#ifdef __APPLE__  // saves the rest as soon as a thread first uses it, and does not say so before
  constexpr std::uint32_t kAllVectors = kVectors;
#else
  constexpr std::uint32_t kAllVectors = 0xe6;  // masks and upper halves, too
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
  return features;
}

}  // namespace mien::kernels
