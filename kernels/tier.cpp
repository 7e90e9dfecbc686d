#include "kernels/tier.h"

#include <atomic>

#ifdef MIEN_HAVE_AVX512FP16
#include <cpuid.h>
#endif
#if defined(__linux__) && (defined(MIEN_HAVE_NEON32) || defined(MIEN_HAVE_NEONFP16))
#include <sys/auxv.h>
#endif
#if defined(__APPLE__) && defined(MIEN_HAVE_NEONFP16)
extern "C" int sysctlbyname(const char* name, void* value, std::size_t* bytes, void* next,
                            std::size_t next_bytes);  // as sys/sysctl.h has it
#endif

namespace mien::kernels {
namespace {

#ifdef MIEN_HAVE_AVX512FP16
// Leaf 7, subleaf 0, EDX bit 23 (Intel SDM, volume 2, CPUID), which clang 14 cannot ask for.
bool has_avx512fp16() {
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  return __get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) != 0 && (edx & 1u << 23) != 0;
}
#endif

#ifdef MIEN_HAVE_NEONFP16
bool has_neon_fp16() {
#if defined(__linux__)
  constexpr unsigned long kHwcapAsimdHp = 1ul << 10;  // the Linux kernel's asm/hwcap.h for AArch64
  return (getauxval(AT_HWCAP) & kHwcapAsimdHp) != 0;
#elif defined(__APPLE__)
  int has = 0;
  std::size_t bytes = sizeof has;
  return sysctlbyname("hw.optional.arm.FEAT_FP16", &has, &bytes, nullptr, 0) == 0 && has != 0;
#else
  return false;
#endif
}
#endif

std::uint32_t ask_cpu() {
  std::uint32_t mask = 0;
#ifndef MIEN_TRIM_REF
  mask |= bit(Tier::kRef);
#endif
#ifdef MIEN_HAVE_AVX2
  // The built-in also asks (XGETBV) whether the system saves the registers. There is no CPU with
  // AVX2 and without F16C, which clang 14 cannot ask for.
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    mask |= bit(Tier::kAvx2);
  }
#endif
#ifdef MIEN_HAVE_AVX512
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("fma")) {
    mask |= bit(Tier::kAvx512);
  }
#endif
#ifdef MIEN_HAVE_AVX512FP16
  if ((mask & bit(Tier::kAvx512)) != 0 && has_avx512fp16()) {
    mask |= bit(Tier::kAvx512Fp16);
  }
#endif
#ifdef MIEN_HAVE_AVX512VNNI
  if ((mask & bit(Tier::kAvx512)) != 0 && __builtin_cpu_supports("avx512vnni")) {
    mask |= bit(Tier::kAvx512Vnni);
  }
#endif
#ifdef MIEN_HAVE_NEON
  mask |= bit(Tier::kNeon);  // every AArch64 CPU has it
#endif
#ifdef MIEN_HAVE_NEONFP16
  if (has_neon_fp16()) {
    mask |= bit(Tier::kNeonFp16);
  }
#endif
#ifdef MIEN_HAVE_NEON32
  // Bits of the Linux kernel's asm/hwcap.h for ARM. VFPv4 brings multiply-adds and half precision.
  constexpr unsigned long kHwcapNeon = 1ul << 12, kHwcapVfpv4 = 1ul << 16;
  constexpr unsigned long kWanted = kHwcapNeon | kHwcapVfpv4;
  if ((getauxval(AT_HWCAP) & kWanted) == kWanted) {
    mask |= bit(Tier::kNeon32);
  }
#endif
#ifdef MIEN_HAVE_WASM
  mask |= bit(Tier::kWasm);  // an engine without SIMD128 would have refused the whole module
#endif
  return mask;
}

}  // namespace

const char* name(Tier tier) {
  switch (tier) {
    case Tier::kRef:
      return "ref";
    case Tier::kAvx2:
      return "avx2";
    case Tier::kAvx512:
      return "avx512";
    case Tier::kNeon:
      return "neon";
    case Tier::kNeonFp16:
      return "neonfp16";
    case Tier::kNeon32:
      return "neon32";
    case Tier::kWasm:
      return "wasm";
    case Tier::kAvx512Fp16:
      return "avx512fp16";
    case Tier::kAvx512Vnni:
      return "avx512vnni";
  }
  return nullptr;
}

std::uint32_t detect_cpu() {
  // Every kernel that is looked up asks, and in virtual machines CPUID takes tens of microseconds.
  // Two threads that come first find the same. Bit 30 is no tier: the CPU was asked.
  constexpr std::uint32_t kAsked = 1u << 30;
  static constinit std::atomic<std::uint32_t> answer = 0;
  std::uint32_t mask = answer.load(std::memory_order_relaxed);
  if (mask == 0) {
    mask = ask_cpu() | kAsked;
    answer.store(mask, std::memory_order_relaxed);
  }
  return mask & ~kAsked;
}

}  // namespace mien::kernels
