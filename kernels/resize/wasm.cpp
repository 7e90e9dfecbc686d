// The wasm tier of resize.
#include "kernels/resize/resize_of.h"

#include "kernels/families.h"

namespace mien::kernels::wasm {

void resize(const ResizeArgs& args) { resize_any(args); }

}  // namespace mien::kernels::wasm
