// The wasm tier of combine.
#include "kernels/combine/combine_of.h"

#include "kernels/families.h"

namespace mien::kernels::wasm {

void combine(const CombineArgs& args) { combine_any(args); }

}  // namespace mien::kernels::wasm
