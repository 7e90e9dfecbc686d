// Replaces kernels/detect_cpu.cpp: every compiled tier is emulated, so every CPU supports it.
#include "kernels/registry.h"

namespace mien::kernels {

std::uint32_t detect_cpu() {
  std::uint32_t mask = 0;
  for (const Entry& entry : all_kernels()) {
    mask |= bit(entry.tier);
  }
  return mask;
}

}  // namespace mien::kernels
