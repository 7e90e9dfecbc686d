// Detects the tiers that the CPU supports.
#include "kernels/tier.h"

#include <atomic>

#ifdef MIEN_HAVE_AVX2
#include "kernels/x86_features.h"
#endif
#if defined(__linux__) && (defined(MIEN_HAVE_NEON32) || defined(MIEN_HAVE_NEONFP16))
#include <sys/auxv.h>
#endif
#if defined(__APPLE__) && defined(MIEN_HAVE_NEONFP16)
extern "C" int sysctlbyname(const char* name, void* value, std::size_t* bytes, void* next,
                            std::size_t next_bytes);  // declared as in sys/sysctl.h
#endif

namespace mien::kernels {
namespace {

#ifdef MIEN_HAVE_NEONFP16
// `hwcap`: a bit of the Linux kernel's asm/hwcap.h for AArch64; `hwcap2`: of its second word;
// `sysctl`: Apple's name.
bool has_feature([[maybe_unused]] unsigned long hwcap, [[maybe_unused]] unsigned long hwcap2,
                 [[maybe_unused]] const char* sysctl) {
#if defined(__linux__)
  return ((getauxval(AT_HWCAP) & hwcap) | (getauxval(AT_HWCAP2) & hwcap2)) != 0;
#elif defined(__APPLE__)
  int has = 0;
  std::size_t bytes = sizeof has;
  return sysctlbyname(sysctl, &has, &bytes, nullptr, 0) == 0 && has != 0;
#else
  return false;
#endif
}
bool has_neon_fp16() { return has_feature(1ul << 10, 0, "hw.optional.arm.FEAT_FP16"); }
#endif
#ifdef MIEN_HAVE_NEONDOT
bool has_neon_dot() {
  return has_neon_fp16() && has_feature(1ul << 20, 0, "hw.optional.arm.FEAT_DotProd");
}
#endif
#ifdef MIEN_HAVE_NEONI8MM
bool has_neon_i8mm() {
  return has_neon_fp16() && has_feature(0, 1ul << 13, "hw.optional.arm.FEAT_I8MM");
}
#endif

std::uint32_t query_cpu() {
  std::uint32_t mask = 0;
#ifndef MIEN_TRIM_REF
  mask |= bit(Tier::kRef);
#endif
#ifdef MIEN_HAVE_AVX2
  const X86Features x86 = x86_features();
  mask |= x86.avx2 ? bit(Tier::kAvx2) : 0u;
#endif
#ifdef MIEN_HAVE_AVX2INT16
  mask |= x86.avx2 ? bit(Tier::kAvx2Int16) : 0u;
#endif
#ifdef MIEN_HAVE_AVXVNNI
  mask |= x86.avxvnni ? bit(Tier::kAvxVnni) : 0u;
#endif
#ifdef MIEN_HAVE_AVX512
  mask |= x86.avx512 ? bit(Tier::kAvx512) : 0u;
#endif
#ifdef MIEN_HAVE_AVX512FP16
  mask |= x86.avx512fp16 ? bit(Tier::kAvx512Fp16) : 0u;
#endif
#ifdef MIEN_HAVE_AVX512VNNI
  mask |= x86.avx512vnni ? bit(Tier::kAvx512Vnni) : 0u;
#endif
#ifdef MIEN_HAVE_NEON
  mask |= bit(Tier::kNeon);  // every AArch64 CPU has it
#endif
#ifdef MIEN_HAVE_NEONFP16
  if (has_neon_fp16()) {
    mask |= bit(Tier::kNeonFp16);
  }
#endif
#ifdef MIEN_HAVE_NEONDOT
  if (has_neon_dot()) {
    mask |= bit(Tier::kNeonDot);
  }
#endif
#ifdef MIEN_HAVE_NEONI8MM
  if (has_neon_i8mm()) {
    mask |= bit(Tier::kNeonI8mm);
  }
#endif
#ifdef MIEN_HAVE_NEON32
  // Bits of the Linux kernel's asm/hwcap.h for ARM. VFPv4 adds fused multiply-add and half
  // precision.
  constexpr unsigned long kHwcapNeon = 1ul << 12, kHwcapVfpv4 = 1ul << 16;
  constexpr unsigned long kWanted = kHwcapNeon | kHwcapVfpv4;
  if ((getauxval(AT_HWCAP) & kWanted) == kWanted) {
    mask |= bit(Tier::kNeon32);
  }
#endif
#ifdef MIEN_HAVE_WASM
  mask |= bit(Tier::kWasm);  // engines without SIMD128 reject the whole module
#endif
#ifdef MIEN_HAVE_WASMINT16
  mask |= bit(Tier::kWasmInt16);
#endif
  return mask;
}

}  // namespace

std::uint32_t detect_cpu() {
  // Cached, because every kernel lookup needs it and CPUID takes tens of microseconds in virtual
  // machines. Racing threads store the same value. Bit 30, which is not a tier, marks a valid
  // value.
  constexpr std::uint32_t kValid = 1u << 30;
  static constinit std::atomic<std::uint32_t> cached = 0;
  std::uint32_t mask = cached.load(std::memory_order_relaxed);
  if (mask == 0) {
    mask = query_cpu() | kValid;
    cached.store(mask, std::memory_order_relaxed);
  }
  return mask & ~kValid;
}

}  // namespace mien::kernels
