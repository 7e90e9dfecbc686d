// The reference kernel of fully_connected.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {

void fully_connected(const FullyConnectedArgs& a) {
  for (std::int32_t o = 0; o < blocks_of(a.out_c) * kBlock; ++o) {
    double sum = half_to_float(a.bias[o]);
    for (std::int32_t k = 0; k < a.in_elems; ++k) {
      sum += panel_weight(a.weights, a.out_c, a.in_elems, o, k) * static_cast<double>(a.x[k]);
    }
    a.y[o] = o < a.out_c ? static_cast<float>(activated(sum, a.activation, o)) : 0.0f;
  }
}

}  // namespace mien::kernels::ref
