// The wasm tier of rearrange.
#include "kernels/rearrange/rearrange_of.h"

#include "kernels/families.h"

namespace mien::kernels::wasm {

void rearrange(const RearrangeArgs& args) { rearrange_any(args); }

}  // namespace mien::kernels::wasm
