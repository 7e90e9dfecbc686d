// The neonfp16 tier of inverted_residual: strips and bands in half precision, 16 channels per
// panel.
#include "kernels/common/neon_half.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/half_strips.h"
#include "kernels/inverted_residual/neon_depthwise.h"

namespace mien::kernels::neonfp16 {
namespace {

struct Halves {
  using Value = Half;
  using Vec = HalfVec;
  static constexpr int kLanes = kHalves;
  static constexpr int kVecs = 2;
  static Vec load(const Half* at) { return load_halves(at); }
  static void store(Half* at, Vec x) { store_halves(at, x); }
  static Vec weights(const Half* at) { return load_halves(at); }
  static Vec fma(Vec sum, Vec a, Vec b) { return vfmaq_f16(sum, a, b); }
  static Vec clamped(Vec x, Vec low, Vec high) { return vminq_f16(vmaxq_f16(x, low), high); }
};

struct Tier {
  static constexpr std::int32_t kPanel = neonfp16::kPanel;

  static void half_input(const float* x, std::ptrdiff_t plane, std::int32_t blocks, Half* y) {
    store_halves(y, to_half(load_pair(x)));
    store_halves(y + kHalves, to_half(load_pair(x + (blocks > 1 ? plane : 0))));
  }

  static void depthwise(const InvertedResidualArgs& a, const DepthwisePart<Half>& s, Half* y) {
    const std::ptrdiff_t taps_elems = std::ptrdiff_t{a.kernel_h} * a.kernel_w * kBlock;
    const bool both = s.blocks > 1;  // otherwise the upper vector is unused
    const Taps<Halves> taps(a.depthwise.weights + s.block * taps_elems, both ? taps_elems : 0,
                            a.depthwise.bias + std::ptrdiff_t{s.block} * kBlock, both ? kBlock : 0,
                            splat_halves(s.clamp.low), splat_halves(s.clamp.high));
    const std::ptrdiff_t y_row = std::ptrdiff_t{a.out_w} * kPanel;
    depthwise_rows<Halves, kPanel>(a, taps, {s.x, s.x_row_elems, y, y_row}, s.rows);
  }

  static void multiply_to_strip(const HalfProduct& product, const StripRows& to) {
    neonfp16::multiply_to_strip(product, to);
  }
  static void multiply_to_map(const HalfProduct& product, const MapRows& to, float* /*wide*/) {
    neonfp16::multiply_to_map(product, to);
  }
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) {
  if (HalfStrips<Tier>::can_run(a)) {
    InvertedResidual<HalfStrips<Tier>>(a).run();
  } else {
    neon::inverted_residual(a);
  }
}

}  // namespace mien::kernels::neonfp16
