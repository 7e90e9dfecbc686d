// The strips of ARM tiers with half precision: 16 channels per panel. Products are those of
// neonfp16.
#pragma once

#include "kernels/common/neon_half.h"
#include "kernels/inverted_residual/half_strips.h"
#include "kernels/inverted_residual/neon_depthwise.h"

namespace mien::kernels::MIEN_TIER {
namespace {

struct Halves {
  using Value = Half;
  using Vec = HalfVec;
  using Finish = Clamp<Halves>;
  static constexpr int kLanes = kHalves;
  static constexpr int kVecs = 2;
  static Vec load(const Half* at) { return load_halves(at); }
  static void store(Half* at, Vec x) { store_halves(at, x); }
  static Vec weights(const Half* at) { return load_halves(at); }
  static Vec fma(Vec sum, Vec a, Vec b) { return vfmaq_f16(sum, a, b); }
  static Vec clamped(Vec x, Vec low, Vec high) { return vminq_f16(vmaxq_f16(x, low), high); }
};

// N: Halves, with a Finish that writes the band at y, whose pixels are kYPixel values apart.
template <class N, int kYPixel>
void depthwise_panel(const InvertedResidualArgs& a, const DepthwisePart<Half>& s,
                     const typename N::Finish& finish, typename N::Finish::Output* y) {
  const std::ptrdiff_t taps_elems = std::ptrdiff_t{a.kernel_h} * a.kernel_w * kBlock;
  const bool both = s.blocks > 1;  // otherwise the upper vector is unused
  const Taps<N> taps(a.depthwise.weights + s.block * taps_elems, both ? taps_elems : 0,
                     a.depthwise.bias + std::ptrdiff_t{s.block} * kBlock, both ? kBlock : 0,
                     finish);
  const std::ptrdiff_t y_row = std::ptrdiff_t{a.out_w} * kYPixel;
  depthwise_rows<N, kYPixel>(a, taps, {s.x, s.x_row_elems, y, y_row}, s.rows);
}

struct HalfTier {
  static constexpr std::int32_t kPanel = MIEN_TIER::kPanel;

  static void half_input(const float* x, std::ptrdiff_t plane, std::int32_t blocks, Half* y) {
    store_halves(y, to_half(load_pair(x)));
    store_halves(y + kHalves, to_half(load_pair(x + (blocks > 1 ? plane : 0))));
  }
  static void depthwise(const InvertedResidualArgs& a, const DepthwisePart<Half>& s, Half* y) {
    depthwise_panel<Halves, kPanel>(a, s, {splat_halves(s.clamp.low), splat_halves(s.clamp.high)},
                                    y);
  }
  static void multiply_to_strip(const HalfProduct& product, const StripRows& to) {
    neonfp16::multiply_to_strip(product, to);
  }
  static void multiply_to_map(const HalfProduct& product, const MapRows& to, float* /*wide*/) {
    neonfp16::multiply_to_map(product, to);
  }
};

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
