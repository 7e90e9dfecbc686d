// The neon and neon32 tiers of rearrange.
#include "kernels/rearrange/rearrange_of.h"

#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void rearrange(const RearrangeArgs& args) { rearrange_any(args); }

}  // namespace mien::kernels::MIEN_TIER
