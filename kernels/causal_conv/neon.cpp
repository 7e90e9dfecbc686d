// The neon and neon32 tiers of causal_conv.
#include "kernels/common/neon_matvec.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void causal_conv(const CausalConvArgs& a) {
  matvec({a.previous, a.in_elems, a.x, a.in_elems}, a.weights, a.bias, a.activation, a.out_c, a.y);
  for (std::int32_t k = 0; k < a.in_elems; k += kBlock) {
    store_pair(a.previous + k, load_pair(a.x + k));
  }
}

}  // namespace mien::kernels::MIEN_TIER
