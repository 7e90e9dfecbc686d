// The avx2 tier of curve.
#include "kernels/curve/curve_of.h"

#include "kernels/families.h"

namespace mien::kernels::avx2 {

void curve(const CurveArgs& args) { curve_any(args); }

}  // namespace mien::kernels::avx2
