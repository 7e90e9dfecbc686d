// The strips of tiers that multiply 16-bit integers. Strips are fp32; the inputs of expand and
// project are integers: the map scaled by its largest magnitude, the band by the bound of its
// clamp. A tier supplies
//   load(x, y)                            copies 8 floats from x to y
//   largest_of(x, elems)                  largest magnitude, at least kSmallestLargest
//   quantize(x, elems, inverse_scale, y)  converts floats to integers
//   depthwise(args, part, y)              writes quantized rows of the band at y
//   multiply(product)
// `elems` are multiples of 8.
#pragma once

#include "kernels/inverted_residual/float_strips.h"
#include "kernels/inverted_residual/quantized_product.h"

namespace mien::kernels {
namespace {

// Maps of far smaller values become 0.
inline constexpr float kSmallestLargest = 0x1p-64f;

// 8 integers of the band occupy the memory of 4 floats.
inline constexpr std::ptrdiff_t kQuantizedBand = kStripBlock / 2;

// Factor that quantizes the band: its range 0..high becomes 0..kQuantizedBandMax.
inline float band_factor(float high) { return static_cast<float>(kQuantizedBandMax) / high; }

template <class Tier>
class QuantizedStrips {
 public:
  using Value = float;
  static constexpr std::int32_t kPanel = kFloatPanel;

  [[nodiscard]] static bool can_run(const InvertedResidualArgs& args) {
    const StripClamp clamp = clamp_of(args.depthwise.activation);
    const bool is_bounded = clamp.low == 0.0f && clamp.high < __builtin_inff();
    return args.project.pairs != nullptr && is_bounded;
  }

  explicit QuantizedStrips(const InvertedResidualArgs& args, Tier tier = Tier())
      : a_(args), tier_(tier), map_(reinterpret_cast<std::int16_t*>(args.half_input)) {
    if (a_.expand.weights != nullptr) {
      largest_ = Tier::largest_of(a_.x, (a_.in_c + 7) / 8 * map_plane());
    }
  }

  void begin(std::int32_t first, std::int32_t rows) {
    if (a_.expand.weights == nullptr) {
      return;
    }
    first_row_ = first;
    plane_elems_ = std::ptrdiff_t{rows} * a_.in_w * kStripBlock;
    const float inverse_scale = static_cast<float>(kQuantizedMapMax) / largest_;
    const float* x = a_.x + std::ptrdiff_t{first} * a_.in_w * kStripBlock;
    for (std::int32_t block = 0; block < (a_.in_c + 7) / 8; ++block) {
      Tier::quantize(x + block * map_plane(), plane_elems_, inverse_scale,
                     map_ + block * plane_elems_);
    }
  }

  void expand(const StripPart& part, std::int32_t row, std::int32_t rows, float* y) const {
    const std::ptrdiff_t channel = std::ptrdiff_t{part.first} * kStripBlock;
    QuantizedProduct product{};
    product.to = expansion(a_, part, row, rows, y);
    product.values = map_ + std::ptrdiff_t{row - first_row_} * a_.in_w * kStripBlock;
    product.plane_elems = plane_elems_;
    product.x_scale = largest_ / static_cast<float>(kQuantizedMapMax);
    product.pairs = a_.expand.pairs + channel * product.to.in_blocks * kStripBlock;
    product.scales = a_.expand.scales + channel;
    tier_.multiply(product);
  }

  void copy(const StripPart& part, std::int32_t row, std::int32_t rows, float* y) const {
    copy_rows(a_, part, row, rows, y, &Tier::load);
  }

  void depthwise(const DepthwisePart<float>& s) const {
    float* y = a_.band + s.block * band_plane(a_, s) / 2 +
               std::ptrdiff_t{s.row} * a_.out_w * kQuantizedBand;
    Tier::depthwise(a_, s, y);
  }

  void project(std::int32_t first, std::int32_t rows) const {
    QuantizedProduct product{};
    product.to = projection(a_, first, rows);
    product.values = reinterpret_cast<const std::int16_t*>(a_.band);
    product.plane_elems = product.to.x_plane_elems;
    product.x_scale =
        clamp_of(a_.depthwise.activation).high / static_cast<float>(kQuantizedBandMax);
    product.pairs = a_.project.pairs;
    product.scales = a_.project.scales;
    tier_.multiply(product);
  }

 private:
  [[nodiscard]] std::ptrdiff_t map_plane() const {
    return std::ptrdiff_t{a_.in_h} * a_.in_w * kStripBlock;
  }

  const InvertedResidualArgs& a_;
  Tier tier_;
  std::int16_t* map_;  // starts with row `first_row_`
  std::int32_t first_row_ = 0;
  std::ptrdiff_t plane_elems_ = 0;
  float largest_ = 0.0f;
};

}  // namespace
}  // namespace mien::kernels
