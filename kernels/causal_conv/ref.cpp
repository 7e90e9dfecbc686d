// The reference kernel of causal_conv.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {

void causal_conv(const CausalConvArgs& a) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{2} * a.in_elems;
  for (std::int32_t o = 0; o < blocks_of(a.out_c) * kBlock; ++o) {
    double sum = half_to_float(a.bias[o]);
    for (std::int32_t k = 0; k < a.in_elems; ++k) {
      sum += panel_weight(a.weights, a.out_c, reduction, o, k) * static_cast<double>(a.previous[k]);
      sum += panel_weight(a.weights, a.out_c, reduction, o, a.in_elems + k) *
             static_cast<double>(a.x[k]);
    }
    a.y[o] = o < a.out_c ? static_cast<float>(activated(sum, a.activation, o)) : 0.0f;
  }
  std::copy_n(a.x, a.in_elems, a.previous);
}

}  // namespace mien::kernels::ref
