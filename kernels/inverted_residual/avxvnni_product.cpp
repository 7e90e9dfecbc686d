// The products of the avxvnni tier.
#include "kernels/common/avxvnni.h"
#include "kernels/inverted_residual/avx2_quantized_product.h"

namespace mien::kernels::avxvnni {

void multiply_quantized(const QuantizedProduct& a) {
  a.is_int8() ? avx2::QuantizedTiles<Quads>::multiply(a) : avx2::QuantizedTiles<Pairs>::multiply(a);
}

}  // namespace mien::kernels::avxvnni
