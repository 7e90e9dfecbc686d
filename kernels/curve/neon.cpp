// The neon and neon32 tiers of curve.
#include "kernels/curve/curve_of.h"

#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void curve(const CurveArgs& args) { curve_any(args); }

}  // namespace mien::kernels::MIEN_TIER
