// The neon and neon32 tiers of resize.
#include "kernels/resize/resize_of.h"

#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void resize(const ResizeArgs& args) { resize_any(args); }

}  // namespace mien::kernels::MIEN_TIER
