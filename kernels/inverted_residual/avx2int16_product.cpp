// The products of the avx2int16 tier.
#include "kernels/common/avx2int16.h"
#include "kernels/inverted_residual/avx2_quantized_product.h"

namespace mien::kernels::avx2int16 {

void multiply_quantized(const QuantizedProduct& a) { avx2::QuantizedTiles<Pairs>::multiply(a); }

}  // namespace mien::kernels::avx2int16
