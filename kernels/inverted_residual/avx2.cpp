// The avx2 tier of inverted_residual. Its depthwise part computes 8 channels at once: half a panel.
#include "kernels/common/avx2.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/depthwise_rows.h"
#include "kernels/inverted_residual/float_strips.h"

namespace mien::kernels::avx2 {
namespace {

struct Window {
  using Value = float;
  using Vec = avx2::Vec;
  static constexpr std::ptrdiff_t kStrip = kPanel, kBand = kLanes;

  const InvertedResidualArgs& a;
  std::ptrdiff_t x_row_elems;
  const std::uint16_t* weights;  // [kernel_h][kernel_w][8]
  Vec bias, low, high;

  static Vec load(const float* x) { return _mm256_loadu_ps(x); }
  static Vec fma(Vec sum, Vec value, Vec weight) { return _mm256_fmadd_ps(value, weight, sum); }
  [[nodiscard]] Vec weight(int tap) const { return load_half(weights + tap * kLanes); }
  void store(Vec sum, float* y) const {
    _mm256_storeu_ps(y, _mm256_min_ps(high, _mm256_max_ps(low, sum)));
  }
};

// `half` 0: the lower 8 channels of the panel; 1: the upper 8.
void depthwise_half(const InvertedResidualArgs& a, const DepthwisePart<float>& s,
                    std::int32_t half) {
  const std::ptrdiff_t taps = std::ptrdiff_t{a.kernel_h} * a.kernel_w;
  const std::int32_t block = s.block + half;
  const Window window{a,
                      s.x_row_elems,
                      a.depthwise.weights + block * taps * kLanes,
                      load_half(a.depthwise.bias + block * kLanes),
                      _mm256_set1_ps(s.clamp.low),
                      _mm256_set1_ps(s.clamp.high)};
  DepthwiseRows<Window>::run(window, s.rows, s.x + std::ptrdiff_t{half} * kLanes,
                             band_at(a, s) + half * band_plane(a, s));
}

struct Tier2 {
  static void multiply(const ProductArgs& args) { multiply_panels(args); }

  static void depthwise(const InvertedResidualArgs& a, const DepthwisePart<float>& s) {
    depthwise_half(a, s, 0);
    if (s.blocks > 1) {
      depthwise_half(a, s, 1);
    }
  }

  static void load(const float* x, float* y) { _mm256_storeu_ps(y, _mm256_loadu_ps(x)); }
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) {
  InvertedResidual<FloatStrips<Tier2>>(a).run();
}

}  // namespace mien::kernels::avx2
