#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {

void batch_norm(const BatchNormArgs& a) {
  for (std::int32_t c = 0; c < blocks_of(a.channels) * kBlock; ++c) {
    for (std::int32_t p = 0; p < a.pixels; ++p) {
      float& y = a.y[blocked(c, p, a.pixels)];
      if (c >= a.channels) {
        y = 0.0f;
        continue;
      }
      const double deviation = std::sqrt(static_cast<double>(a.variance[c]) + a.epsilon);
      const double centred = static_cast<double>(a.x[blocked(c, p, a.pixels)]) - a.mean[c];
      y = static_cast<float>(centred / deviation * a.gain[c] + a.offset[c]);
    }
  }
}

}  // namespace mien::kernels::ref
