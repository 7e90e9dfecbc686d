// The avx512 tier of inverted_residual. Its depthwise part computes 16 channels at once: a panel.
#include "kernels/common/avx512.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/avx512_depthwise.h"
#include "kernels/inverted_residual/depthwise_rows.h"
#include "kernels/inverted_residual/float_strips.h"

namespace mien::kernels::avx512 {
namespace {

struct Window {
  using Value = float;
  using Vec = avx512::Vec;
  static constexpr std::ptrdiff_t kStrip = kPanel, kBand = kBlock;

  const InvertedResidualArgs& a;
  const DepthwisePart<float>& s;
  std::ptrdiff_t x_row_elems;
  std::ptrdiff_t y_plane_elems;
  bool both;  // the upper 8 channels exist
  Vec bias, low, high;

  static Vec load(const float* x) { return _mm512_loadu_ps(x); }
  static Vec fma(Vec sum, Vec value, Vec weight) { return _mm512_fmadd_ps(value, weight, sum); }
  [[nodiscard]] Vec weight(int tap) const { return weights_at(a, s, tap); }
  void store(Vec sum, float* y) const {
    store_blocks(y, y_plane_elems, both, _mm512_min_ps(high, _mm512_max_ps(low, sum)));
  }
};

struct Tier512 {
  static void multiply(const ProductArgs& args) { multiply_panels(args); }

  static void depthwise(const InvertedResidualArgs& a, const DepthwisePart<float>& s) {
    const bool both = s.blocks > 1;
    const Window window{a,
                        s,
                        s.x_row_elems,
                        band_plane(a, s),
                        both,
                        load_half(a.depthwise.bias + s.block * kBlock, both ? 0xFFFF : 0xFF),
                        _mm512_set1_ps(s.clamp.low),
                        _mm512_set1_ps(s.clamp.high)};
    DepthwiseRows<Window>::run(window, s.rows, s.x, band_at(a, s));
  }

  static void load(const float* x, float* y) { _mm256_storeu_ps(y, _mm256_loadu_ps(x)); }
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) {
  InvertedResidual<FloatStrips<Tier512>>(a).run();
}

}  // namespace mien::kernels::avx512
