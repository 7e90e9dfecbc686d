// The global_average_pool kernel of all vector tiers. Long sums in fp32 lose precision, up to
// ignoring further terms. Maps are therefore summed in parts, and the parts are added in double
// precision.
#include <algorithm>

#include "kernels/common/simd.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

constexpr std::int32_t kPartPixels = 256;

// Sums the parts of a block of 8 channels.
class TotalOfParts {
 public:
  void add(const float (&part)[kBlock]) {
    for (int i = 0; i < kBlock; ++i) {
      sums_[i] += static_cast<double>(part[i]);
    }
  }
  void store_mean(std::int32_t pixels, float* y) const {
    const double scale = 1.0 / pixels;
    for (int i = 0; i < kBlock; ++i) {
      y[i] = static_cast<float>(sums_[i] * scale);
    }
  }

 private:
  double sums_[kBlock] = {};
};

// Sums up to kPartPixels pixels of a block. Four sums hide the latency of additions.
void sum_of_part(const float* x, std::int32_t pixels, float (&part)[kBlock]) {
  constexpr int kSums = 4;
  BlockVec sums[kSums];
  MIEN_UNROLLED for (int i = 0; i < kSums; ++i) { sums[i] = splat_block(0.0f); }
  for (; pixels >= kSums; pixels -= kSums, x += kSums * kBlock) {
    MIEN_UNROLLED for (int i = 0; i < kSums; ++i) {
      sums[i] = add(sums[i], load_block(x + i * kBlock));
    }
  }
  for (; pixels > 0; --pixels, x += kBlock) {
    sums[0] = add(sums[0], load_block(x));
  }
  store_block(part, add(add(sums[0], sums[1]), add(sums[2], sums[3])));
}

}  // namespace

void global_average_pool(const GlobalAveragePoolArgs& a) {
  const float* x = a.x;
  for (std::int32_t channel = 0; channel < a.channels; channel += kBlock) {
    TotalOfParts total;
    for (std::int32_t first = 0; first < a.pixels; first += kPartPixels) {
      const std::int32_t pixels = std::min(kPartPixels, a.pixels - first);
      float part[kBlock];
      sum_of_part(x, pixels, part);
      total.add(part);
      x += std::ptrdiff_t{pixels} * kBlock;
    }
    total.store_mean(a.pixels, a.y + channel);
  }
}

}  // namespace mien::kernels::MIEN_TIER
