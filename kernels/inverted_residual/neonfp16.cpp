// The neonfp16 tier of inverted_residual: strips and bands in half precision.
#include "kernels/families.h"
#include "kernels/inverted_residual/neon_half_strips.h"

namespace mien::kernels::neonfp16 {

void inverted_residual(const InvertedResidualArgs& a) {
  using Strips = HalfStrips<HalfTier>;
  if (Strips::can_run(a)) {
    InvertedResidual<Strips>(a).run();
  } else {
    neon::inverted_residual(a);
  }
}

}  // namespace mien::kernels::neonfp16
