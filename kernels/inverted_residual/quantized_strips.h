// The strips of tiers that multiply integers. Strips are fp32; the inputs of expand and project are
// integers: of 16 bits, the map scaled by its largest magnitude, the band by the bound of its
// clamp; of 8 bits, both scaled by the layer's input bound. A tier supplies
//   load(x, y)                            copies 8 floats from x to y
//   largest_of(x, elems)                  largest magnitude, at least kMinMagnitude
//   quantize(x, elems, inverse_scale, y)  converts floats to integers of 16 bits
//   quantize_to_int8(x, pixels, inverse_scale, y)
//                                         writes integers plus kInt8Shift to half of each pixel
//   depthwise(args, part, quantization, y)  writes quantized rows of the band at y
//   multiply(product)
// `elems` are multiples of 8. Tiers without 8 bits never call quantize_to_int8.
#pragma once

#include <algorithm>

#include "kernels/inverted_residual/float_strips.h"
#include "kernels/inverted_residual/quantized_product.h"

namespace mien::kernels {
namespace {

// Maps of far smaller values become 0.
inline constexpr float kMinMagnitude = 0x1p-64f;

// A pixel of the band, 8 integers of 16 bits or 16 of 8 bits, occupies the memory of 4 floats.
inline constexpr std::ptrdiff_t kQuantizedBand = 4;

// How the band is quantized: its range 0..bound becomes 0..max.
struct BandQuantization {
  float bound, max;
  bool is_int8;
  [[nodiscard]] float factor() const { return max / bound; }
  [[nodiscard]] float scale() const { return bound / max; }
};

inline BandQuantization band_quantization(const InvertedResidualArgs& a) {
  const float high = clamp_of(a.depthwise.activation).high;
  return a.project.quads != nullptr
             ? BandQuantization{std::min(a.project.input_bound, high), kInt8BandMax, true}
             : BandQuantization{high, kQuantizedBandMax, false};
}

// Blocks of a QuantizedProduct for `channels` channels.
inline std::int32_t quantized_blocks(std::int32_t channels, bool is_int8) {
  return is_int8 ? (channels + 15) / 16 : (channels + 7) / 8;
}

// Distance in floats between blocks of the band.
inline std::ptrdiff_t quantized_band_plane(const InvertedResidualArgs& a,
                                           const DepthwisePart<float>& s) {
  return std::ptrdiff_t{s.band_rows} * a.out_w * kQuantizedBand;
}

template <class Tier>
class QuantizedStrips {
 public:
  using Value = float;
  static constexpr std::int32_t kPanel = kFloatPanel;

  [[nodiscard]] static bool can_run(const InvertedResidualArgs& args) {
    const StripClamp clamp = clamp_of(args.depthwise.activation);
    const bool is_bounded = clamp.low == 0.0f && clamp.high < __builtin_inff();
    return (args.project.pairs != nullptr || args.project.quads != nullptr) && is_bounded;
  }

  explicit QuantizedStrips(const InvertedResidualArgs& args, Tier tier = Tier())
      : a_(args), tier_(tier), map_(reinterpret_cast<std::int16_t*>(args.half_input)) {
    if (a_.expand.quads != nullptr) {
      bound_ = a_.expand.input_bound;
      max_ = kInt8MapMax;
    } else if (a_.expand.weights != nullptr) {
      bound_ = Tier::largest_of(a_.x, (a_.in_c + 7) / 8 * map_plane());
    }
  }

  void begin(std::int32_t first, std::int32_t rows) {
    if (a_.expand.weights == nullptr) {
      return;
    }
    first_row_ = first;
    plane_elems_ = std::ptrdiff_t{rows} * a_.in_w * kStripBlock;
    const float inverse_scale = max_ / bound_;
    const float* x = a_.x + std::ptrdiff_t{first} * a_.in_w * kStripBlock;
    for (std::int32_t block = 0; block < (a_.in_c + 7) / 8; ++block, x += map_plane()) {
      if (a_.expand.quads != nullptr) {
        std::int16_t* pixel = map_ + block / 2 * plane_elems_ + block % 2 * kQuantizedPixel / 2;
        Tier::quantize_to_int8(x, rows * a_.in_w, inverse_scale, pixel);
      } else {
        Tier::quantize(x, plane_elems_, inverse_scale, map_ + block * plane_elems_);
      }
    }
  }

  void expand(const StripPart& part, std::int32_t row, std::int32_t rows, float* y) const {
    const std::ptrdiff_t channel = std::ptrdiff_t{part.first} * kStripBlock;
    QuantizedProduct product = product_of(a_.expand, a_.in_c, expansion(a_, part, row, rows, y));
    product.values = map_ + std::ptrdiff_t{row - first_row_} * a_.in_w * kQuantizedPixel;
    product.plane_elems = plane_elems_;
    product.x_scale = bound_ / max_;
    product.pairs += channel * product.to.in_blocks * kQuantizedPixel;
    product.scales += channel;
    product.sums += product.is_int8() ? channel : 0;
    product.x_shift = kInt8Shift;
    tier_.multiply(product);
  }

  void copy(const StripPart& part, std::int32_t row, std::int32_t rows, float* y) const {
    copy_rows(a_, part, row, rows, y, &Tier::load);
  }

  void depthwise(const DepthwisePart<float>& s) const {
    const BandQuantization quantization = band_quantization(a_);
    const std::int32_t block = quantization.is_int8 ? s.block / 2 : s.block;
    float* y = a_.band + block * quantized_band_plane(a_, s) +
               std::ptrdiff_t{s.row} * a_.out_w * kQuantizedBand;
    Tier::depthwise(a_, s, quantization, y);
  }

  void project(std::int32_t first, std::int32_t rows) const {
    QuantizedProduct product = product_of(a_.project, a_.hidden_c, projection(a_, first, rows));
    product.values = reinterpret_cast<const std::int16_t*>(a_.band);
    product.plane_elems = std::ptrdiff_t{rows} * a_.out_w * kQuantizedPixel;
    product.x_scale = band_quantization(a_).scale();
    tier_.multiply(product);
  }

 private:
  [[nodiscard]] std::ptrdiff_t map_plane() const {
    return std::ptrdiff_t{a_.in_h} * a_.in_w * kStripBlock;
  }

  static QuantizedProduct product_of(const InvertedResidualArgs::Weights& weights,
                                     std::int32_t in_c, const ProductArgs& to) {
    const bool is_int8 = weights.quads != nullptr;
    QuantizedProduct product{};
    product.to = to;
    product.to.in_blocks = quantized_blocks(in_c, is_int8);
    product.pairs = is_int8 ? reinterpret_cast<const std::int16_t*>(weights.quads) : weights.pairs;
    product.scales = weights.scales;
    product.sums = is_int8 ? weights.sums : nullptr;
    return product;
  }

  const InvertedResidualArgs& a_;
  Tier tier_;
  std::int16_t* map_;  // starts with row `first_row_`
  std::int32_t first_row_ = 0;
  std::ptrdiff_t plane_elems_ = 0;
  float bound_ = 0.0f, max_ = kQuantizedMapMax;  // of the map, which becomes -max_..max_
};

}  // namespace
}  // namespace mien::kernels
