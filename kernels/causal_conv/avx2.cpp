// The avx2 tier of causal_conv.
#include "kernels/common/avx2_matvec.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {

void causal_conv(const CausalConvArgs& a) {
  matvec({a.previous, a.in_elems, a.x, a.in_elems}, a.weights, a.bias, a.activation, a.out_c, a.y);
  for (std::int32_t k = 0; k < a.in_elems; k += kLanes) {
    _mm256_storeu_ps(a.previous + k, _mm256_loadu_ps(a.x + k));
  }
}

}  // namespace mien::kernels::avx2
