// The avxvnni tier of fma_peak.
#include "kernels/common/avxvnni.h"
#include "kernels/families.h"
#include "kernels/fma_peak/avx2_integer_peak.h"

namespace mien::kernels::avxvnni {

void fma_peak(const FmaPeakArgs& a) { integer_peak<avx2::IntegerVector<Pairs>>(a); }

}  // namespace mien::kernels::avxvnni
