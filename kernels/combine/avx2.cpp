// The avx2 tier of combine.
#include "kernels/combine/combine_of.h"

#include "kernels/families.h"

namespace mien::kernels::avx2 {

void combine(const CombineArgs& args) { combine_any(args); }

}  // namespace mien::kernels::avx2
