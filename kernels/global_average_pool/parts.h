// Long sums in fp32 lose precision, up to ignoring further terms. Maps are therefore summed in
// parts, and the parts are added in double precision.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "kernels/global_average_pool/global_average_pool.h"

namespace mien::kernels {
namespace {

inline constexpr std::int32_t kPartPixels = 256;

// Sums the parts of a block of 8 channels.
class TotalOfParts {
 public:
  void add(const float (&part)[8]) {
    for (int i = 0; i < 8; ++i) {
      sums_[i] += static_cast<double>(part[i]);
    }
  }
  void store_mean(std::int32_t pixels, float* y) const {
    const double scale = 1.0 / pixels;
    for (int i = 0; i < 8; ++i) {
      y[i] = static_cast<float>(sums_[i] * scale);
    }
  }

 private:
  double sums_[8] = {};
};

// `sum_of_part` writes the sums of up to kPartPixels pixels of a block to 8 floats.
template <class SumOfPart>
void mean_by_parts(const GlobalAveragePoolArgs& a, SumOfPart sum_of_part) {
  const float* x = a.x;
  for (std::int32_t channel = 0; channel < a.channels; channel += 8) {
    TotalOfParts total;
    for (std::int32_t first = 0; first < a.pixels; first += kPartPixels) {
      const std::int32_t pixels = std::min(kPartPixels, a.pixels - first);
      float part[8];
      sum_of_part(x, pixels, part);
      total.add(part);
      x += std::ptrdiff_t{pixels} * 8;
    }
    total.store_mean(a.pixels, a.y + channel);
  }
}

}  // namespace
}  // namespace mien::kernels
