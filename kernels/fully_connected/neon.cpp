// The neon and neon32 tiers of fully_connected.
#include "kernels/common/neon_matvec.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void fully_connected(const FullyConnectedArgs& a) {
  matvec({a.x, a.in_elems, nullptr, 0}, a.weights, a.bias, a.activation, a.out_c, a.y);
}

}  // namespace mien::kernels::MIEN_TIER
