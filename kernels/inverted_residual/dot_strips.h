// The strips of ARM tiers with 8 bits: blocks of neonfp16 whose expand layer, project layer or both
// multiply 8-bit integers. The products need signed values, so the band holds value - kInt8Shift.
#pragma once

#include "kernels/families.h"
#include "kernels/inverted_residual/dot_product.h"
#include "kernels/inverted_residual/neon_half_strips.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Converts sums to 8 bits: integers below 0 or above 255 saturate.
template <class Planes>
struct ToInt8 {
  using Output = std::int8_t;
  HalfVec factor;
  std::ptrdiff_t plane_elems;
  [[gnu::always_inline]] void store(Output* y, const HalfVec (&sums)[2]) const {
    const uint16x8_t low = vcvtnq_u16_f16(vmulq_f16(sums[0], factor));
    const uint16x8_t high = vcvtnq_u16_f16(vmulq_f16(sums[1], factor));
    const uint8x16_t fixed = vqmovn_high_u16(vqmovn_u16(low), high);
    const uint8x16_t shifted = veorq_u8(fixed, vdupq_n_u8(kInt8Shift));
    Planes::store(y, plane_elems, vreinterpretq_s8_u8(shifted));
  }
};

template <class Planes>
struct HalvesToInt8 : Halves {
  using Finish = ToInt8<Planes>;
};

inline int16x8_t fixed(Pair x, Vec factor) {
  const int32x4_t low = vcvtnq_s32_f32(vmulq_f32(x.low, factor));
  const int32x4_t high = vcvtnq_s32_f32(vmulq_f32(x.high, factor));
  return vqmovn_high_s32(vqmovn_s32(low), high);
}

// Converts pixels of two blocks, `plane` floats apart.
template <class Planes>
void quantize_to_int8(const float* x, std::ptrdiff_t plane, std::int32_t pixels,
                      float inverse_scale, std::int8_t* y, std::ptrdiff_t plane_elems) {
  const Vec factor = splat(inverse_scale);
  const int8x16_t lowest = vdupq_n_s8(-kInt8MapMax);
  for (; pixels > 0; --pixels, x += kBlock, y += Planes::kChannels) {
    const int16x8_t low = fixed(load_pair(x), factor), high = fixed(load_pair(x + plane), factor);
    Planes::store(y, plane_elems, vmaxq_s8(vqmovn_high_s16(vqmovn_s16(low), high), lowest));
  }
}

inline float band_bound(const InvertedResidualArgs& a) {
  return std::min(a.project.input_bound, clamp_of(a.depthwise.activation).high);
}

// Maps and bands consist of planes of [pixels][channels]. A tier supplies
//   kChannels                          16 or 8
//   store(y, plane_elems, int8x16_t)   writes 16 channels of a pixel of the plane that contains y
template <class Planes>
class DotStrips {
 public:
  using Value = Half;
  static constexpr std::int32_t kPanel = HalfTier::kPanel;

  [[nodiscard]] static bool can_run(const InvertedResidualArgs& a) {
    const bool expands = a.expand.quads != nullptr, projects = a.project.quads != nullptr;
    const StripClamp clamp = clamp_of(a.depthwise.activation);
    const bool is_bounded = clamp.low == 0.0f && clamp.high < __builtin_inff();
    const bool is_short = has_short_half_sums(a.expand.weights != nullptr && !expands ? a.in_c : 0,
                                              a.kernel_h, a.kernel_w);
    // Otherwise the factor of the band would exceed fp16.
    const bool is_wide = !projects || band_bound(a) >= 0x1p-8f;
    return (expands || projects) && is_bounded && is_short && is_wide;
  }

  explicit DotStrips(const InvertedResidualArgs& args)
      : a_(args),
        halves_(args),
        map_(reinterpret_cast<std::int8_t*>(args.half_input)),
        band_(reinterpret_cast<std::int8_t*>(args.band)) {}

  void begin(std::int32_t first, std::int32_t rows) {
    if (a_.expand.quads == nullptr) {
      return halves_.begin(first, rows);
    }
    first_row_ = first;
    plane_elems_ = std::ptrdiff_t{rows} * a_.in_w * kChannels;
    const std::ptrdiff_t plane = std::ptrdiff_t{a_.in_h} * a_.in_w * kStripBlock;
    const float* x = a_.x + std::ptrdiff_t{first} * a_.in_w * kStripBlock;
    const std::int32_t blocks = half_blocks(a_.in_c);
    for (std::int32_t block = 0; block < blocks; block += 2, x += 2 * plane) {
      quantize_to_int8<Planes>(x, block + 1 < blocks ? plane : 0, rows * a_.in_w,
                               kInt8MapMax / a_.expand.input_bound,
                               map_ + plane_of(block) * plane_elems_, plane_elems_);
    }
  }

  void expand(const StripPart& part, std::int32_t row, std::int32_t rows, Half* y) const {
    if (a_.expand.quads == nullptr) {
      return halves_.expand(part, row, rows, y);
    }
    const std::ptrdiff_t channel = std::ptrdiff_t{part.first} * kStripBlock;
    DotProduct product = product_of(a_.expand, half_expansion(a_, part, rows), channel);
    product.values = map_ + std::ptrdiff_t{row - first_row_} * a_.in_w * kChannels;
    product.plane_elems = plane_elems_;
    product.x_scale = a_.expand.input_bound / kInt8MapMax;
    multiply_to_strip(product, strip_rows(a_, part, y));
  }

  void copy(const StripPart& part, std::int32_t row, std::int32_t rows, Half* y) const {
    halves_.copy(part, row, rows, y);
  }

  void depthwise(const DepthwisePart<Half>& s) const {
    if (a_.project.quads == nullptr) {
      return halves_.depthwise(s);
    }
    const std::ptrdiff_t row_elems = std::ptrdiff_t{a_.out_w} * kChannels;
    const ToInt8<Planes> to_int8{splat_halves(kInt8BandMax / band_bound(a_)),
                                 s.band_rows * row_elems};
    depthwise_panel<HalvesToInt8<Planes>, kChannels>(
        a_, s, to_int8, band_ + (plane_of(s.block) * s.band_rows + s.row) * row_elems);
  }

  void project(std::int32_t first, std::int32_t rows) const {
    if (a_.project.quads == nullptr) {
      return halves_.project(first, rows);
    }
    DotProduct product = product_of(a_.project, half_projection(a_, rows), 0);
    product.values = band_;
    product.plane_elems = std::ptrdiff_t{rows} * a_.out_w * kChannels;
    product.x_scale = band_bound(a_) / kInt8BandMax;
    multiply_to_map(product, map_rows(a_, first));
  }

 private:
  static constexpr std::int32_t kChannels = Planes::kChannels;

  static std::ptrdiff_t plane_of(std::int32_t block) { return block * kBlock / kChannels; }

  // `channel`: the first output.
  static DotProduct product_of(const InvertedResidualArgs::Weights& weights, const HalfProduct& to,
                               std::ptrdiff_t channel) {
    DotProduct product{};
    product.to = to;
    product.quads = weights.quads + channel * ((to.in_blocks + 1) / 2) * kPanel;
    product.scales = weights.scales + channel;
    product.sums = weights.sums + channel;
    return product;
  }

  const InvertedResidualArgs& a_;
  HalfStrips<HalfTier> halves_;  // for layers without 8 bits
  std::int8_t* map_;             // starts with row `first_row_`
  std::int8_t* band_;
  std::int32_t first_row_ = 0;
  std::ptrdiff_t plane_elems_ = 0;  // of the map
};

// Blocks without bounds of 8 bits run in half precision.
template <class Planes>
void run_dot_strips(const InvertedResidualArgs& a) {
  if (DotStrips<Planes>::can_run(a)) {
    InvertedResidual<DotStrips<Planes>>(a).run();
  } else {
    neonfp16::inverted_residual(a);
  }
}

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
