// The reference kernel of normalize.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {

void normalize(const NormalizeArgs& a) {
  for (std::int32_t p = 0; p < a.pixels; ++p) {
    const auto x = [&](std::int32_t c) {
      return static_cast<double>(a.x[blocked(c, p, a.pixels)]);
    };
    double mean = 0.0, variance = 0.0;
    for (std::int32_t c = 0; c < a.channels; ++c) {
      mean += x(c) / a.channels;
    }
    for (std::int32_t c = 0; c < a.channels; ++c) {
      variance += (x(c) - mean) * (x(c) - mean) / a.channels;
    }
    const double scale = 1.0 / std::sqrt(variance + static_cast<double>(a.epsilon));
    for (std::int32_t c = 0; c < blocks_of(a.channels) * kBlock; ++c) {
      const double value = (x(c) - mean) * scale;
      a.y[blocked(c, p, a.pixels)] = c < a.channels ? static_cast<float>(value) : 0.0f;
    }
  }
}

}  // namespace mien::kernels::ref
