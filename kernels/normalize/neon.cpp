// The neon and neon32 tiers of normalize.
#include "kernels/normalize/normalize_of.h"

#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void normalize(const NormalizeArgs& args) { normalize_any(args); }

}  // namespace mien::kernels::MIEN_TIER
