// The avx2 tier of normalize.
#include "kernels/normalize/normalize_of.h"

#include "kernels/families.h"

namespace mien::kernels::avx2 {

void normalize(const NormalizeArgs& args) { normalize_any(args); }

}  // namespace mien::kernels::avx2
