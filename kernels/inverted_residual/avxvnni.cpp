// The avxvnni tier of inverted_residual: blocks of avx2int16 with products of its own.
#include "kernels/families.h"
#include "kernels/inverted_residual/quantized_product.h"

namespace mien::kernels::avxvnni {

void inverted_residual(const InvertedResidualArgs& a) {
  avx2int16::quantized_block(a, &multiply_quantized);
}

}  // namespace mien::kernels::avxvnni
