// The avx512 tier of causal_conv.
#include "kernels/common/avx512_matvec.h"
#include "kernels/families.h"

namespace mien::kernels::avx512 {

void causal_conv(const CausalConvArgs& a) {
  matvec(
      {{a.previous, a.in_elems, a.x, a.in_elems}, a.weights, a.bias, a.activation, a.out_c, a.y});
  for (std::int32_t k = 0; k < a.in_elems; k += kBlock) {
    _mm256_storeu_ps(a.previous + k, _mm256_loadu_ps(a.x + k));
  }
}

}  // namespace mien::kernels::avx512
