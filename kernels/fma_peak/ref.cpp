// The reference kernel of fma_peak.
#include "kernels/families.h"

namespace mien::kernels::ref {

// In double precision, like the other reference kernels.
void fma_peak(const FmaPeakArgs& a) {
  double sum[8] = {1, 2, 3, 4, 5, 6, 7, 8};
  for (std::int64_t i = 0; i < a.rounds; ++i) {
    for (double& one : sum) {
      one = one * 0.999 + 0.001;
    }
  }
  for (int k = 0; k < 8; ++k) {
    a.y[k] = static_cast<float>(sum[k]);
  }
  *a.macs = a.rounds * 8;
}

}  // namespace mien::kernels::ref
