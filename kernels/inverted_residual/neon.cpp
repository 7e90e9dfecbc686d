// The neon and neon32 tiers of inverted_residual.
#include "kernels/families.h"
#include "kernels/inverted_residual/float_strips.h"
#include "kernels/inverted_residual/neon_depthwise.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Computes kVecs vectors of channels from `channel` of the panel on.
void depthwise_channels(const InvertedResidualArgs& a, const DepthwisePart<float>& s,
                        std::int32_t channel) {
  const std::int32_t half = channel / kBlock, lane = channel % kBlock;
  const std::ptrdiff_t block = s.block + half;
  const Taps<Floats> taps(a.depthwise.weights + block * a.kernel_h * a.kernel_w * kBlock + lane,
                          kLanes, a.depthwise.bias + block * kBlock + lane, kLanes,
                          {splat(s.clamp.low), splat(s.clamp.high)});
  const Rows<Floats> at{s.x + channel, s.x_row_elems,
                        band_at(a, s) + half * band_plane(a, s) + lane,
                        std::ptrdiff_t{a.out_w} * kBlock};
  depthwise_rows<Floats, kBlock>(a, taps, at, s.rows);
}

struct Neon {
  static void multiply(const ProductArgs& args) { multiply_panels(args); }

  static void depthwise(const InvertedResidualArgs& a, const DepthwisePart<float>& s) {
    for (std::int32_t channel = 0; channel < s.blocks * kBlock; channel += Floats::kVecs * kLanes) {
      depthwise_channels(a, s, channel);
    }
  }

  static void load(const float* x, float* y) { store_pair(y, load_pair(x)); }
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) {
  InvertedResidual<FloatStrips<Neon>>(a).run();
}

}  // namespace mien::kernels::MIEN_TIER
