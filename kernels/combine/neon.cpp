// The neon and neon32 tiers of combine.
#include "kernels/combine/combine_of.h"

#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void combine(const CombineArgs& args) { combine_any(args); }

}  // namespace mien::kernels::MIEN_TIER
