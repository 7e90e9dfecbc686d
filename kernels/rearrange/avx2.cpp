// The avx2 tier of rearrange.
#include "kernels/rearrange/rearrange_of.h"

#include "kernels/families.h"

namespace mien::kernels::avx2 {

void rearrange(const RearrangeArgs& args) { rearrange_any(args); }

}  // namespace mien::kernels::avx2
