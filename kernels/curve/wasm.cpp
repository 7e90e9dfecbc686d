// The wasm tier of curve.
#include "kernels/curve/curve_of.h"

#include "kernels/families.h"

namespace mien::kernels::wasm {

void curve(const CurveArgs& args) { curve_any(args); }

}  // namespace mien::kernels::wasm
