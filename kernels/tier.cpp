#include "kernels/tier.h"

namespace mien::kernels {

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
  }
  return nullptr;
}

std::uint32_t detect_cpu() {
  std::uint32_t mask = 0;
#ifndef MIEN_TRIM_REF
  mask |= bit(Tier::kRef);
#endif
#ifdef MIEN_HAVE_AVX2
  // The built-in also asks whether the system saves the registers. There is no CPU with AVX2 and
  // without F16C, which clang 14 cannot ask for.
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    mask |= bit(Tier::kAvx2);
  }
#endif
#ifdef MIEN_HAVE_NEON
  mask |= bit(Tier::kNeon);  // every AArch64 CPU has it
#endif
  return mask;
}

}  // namespace mien::kernels
