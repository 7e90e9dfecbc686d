// The reference kernel of activate.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {

void activate(const ActivateArgs& a) {
  for (std::int32_t c = 0; c < blocks_of(a.channels) * kBlock; ++c) {
    for (std::int32_t p = 0; p < a.pixels; ++p) {
      const std::ptrdiff_t at = blocked(c, p, a.pixels);
      a.y[at] = c < a.channels ? static_cast<float>(activated(a.x[at], a.activation, c)) : 0.0f;
    }
  }
}

}  // namespace mien::kernels::ref
