// The avx2int16 tier of fma_peak.
#include "kernels/common/avx2int16.h"
#include "kernels/families.h"
#include "kernels/fma_peak/avx2_integer_peak.h"

namespace mien::kernels::avx2int16 {

void fma_peak(const FmaPeakArgs& a) { integer_peak<avx2::IntegerVector<Pairs>>(a); }

}  // namespace mien::kernels::avx2int16
