// The reference kernel of softmax.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {

void softmax(const SoftmaxArgs& a) {
  for (std::int32_t p = 0; p < a.pixels; ++p) {
    double largest = a.x[blocked(0, p, a.pixels)];
    for (std::int32_t c = 1; c < a.channels; ++c) {
      largest = std::max(largest, static_cast<double>(a.x[blocked(c, p, a.pixels)]));
    }
    double sum = 0.0;
    for (std::int32_t c = 0; c < a.channels; ++c) {
      sum += std::exp(static_cast<double>(a.x[blocked(c, p, a.pixels)]) - largest);
    }
    for (std::int32_t c = 0; c < blocks_of(a.channels) * kBlock; ++c) {
      const std::ptrdiff_t at = blocked(c, p, a.pixels);
      const double value = std::exp(static_cast<double>(a.x[at]) - largest) / sum;
      a.y[at] = c < a.channels ? static_cast<float>(value) : 0.0f;
    }
  }
}

}  // namespace mien::kernels::ref
