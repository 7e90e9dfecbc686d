// The avx512 tier of fully_connected.
#include "kernels/common/avx512_matvec.h"
#include "kernels/families.h"

namespace mien::kernels::avx512 {

void fully_connected(const FullyConnectedArgs& a) {
  matvec({{a.x, a.in_elems, nullptr, 0}, a.weights, a.bias, a.activation, a.out_c, a.y});
}

}  // namespace mien::kernels::avx512
