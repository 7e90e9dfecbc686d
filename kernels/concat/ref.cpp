// The reference kernel of concat.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {

void concat(const ConcatArgs& a) {
  const std::int32_t channels = a.a_channels + a.b_channels;
  for (std::int32_t c = 0; c < blocks_of(channels) * kBlock; ++c) {
    for (std::int32_t p = 0; p < a.pixels; ++p) {
      float& y = a.y[blocked(c, p, a.pixels)];
      if (c < a.a_channels) {
        y = a.a[blocked(c, p, a.pixels)];
      } else {
        y = c < channels ? a.b[blocked(c - a.a_channels, p, a.pixels)] : 0.0f;
      }
    }
  }
}

}  // namespace mien::kernels::ref
