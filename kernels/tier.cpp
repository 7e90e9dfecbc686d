// Names of the tiers.
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
    case Tier::kAvx512Fp16:
      return "avx512fp16";
    case Tier::kAvx512Vnni:
      return "avx512vnni";
    case Tier::kAvx2Int16:
      return "avx2int16";
    case Tier::kAvxVnni:
      return "avxvnni";
    case Tier::kWasmInt16:
      return "wasmint16";
    case Tier::kNeonDot:
      return "neondot";
    case Tier::kNeonI8mm:
      return "neoni8mm";
  }
  return nullptr;
}

}  // namespace mien::kernels
