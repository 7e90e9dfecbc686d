// The reference kernel of global_average_pool.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {

void global_average_pool(const GlobalAveragePoolArgs& a) {
  for (std::int32_t c = 0; c < blocks_of(a.channels) * kBlock; ++c) {
    double sum = 0.0;
    for (std::int32_t p = 0; p < a.pixels; ++p) {
      sum += static_cast<double>(a.x[blocked(c, p, a.pixels)]);
    }
    a.y[c] = c < a.channels ? static_cast<float>(sum / a.pixels) : 0.0f;
  }
}

}  // namespace mien::kernels::ref
