// The wasm tier of causal_conv.
#include "kernels/common/wasm_matvec.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {

void causal_conv(const CausalConvArgs& a) {
  matvec({a.previous, a.in_elems, a.x, a.in_elems}, a.weights, a.bias, a.activation, a.out_c, a.y);
  for (std::int32_t k = 0; k < a.in_elems; k += kLanes) {
    store(a.previous + k, load(a.x + k));
  }
}

}  // namespace mien::kernels::wasm
