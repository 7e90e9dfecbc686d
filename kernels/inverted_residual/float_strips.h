// The strips of tiers that compute in fp32, except for the depthwise part. A tier supplies
//   multiply(const ProductArgs&)   computes expand and project
//   load(x, y)                     copies 8 floats from x to y
#pragma once

#include "kernels/common/product.h"
#include "kernels/inverted_residual/strips.h"

namespace mien::kernels {
namespace {

inline constexpr std::int32_t kFloatPanel = 16;  // channels per panel of a strip

// The lower 8 channels of the first pixel of a depthwise part in the band; distance of the upper 8.
inline std::ptrdiff_t band_plane(const InvertedResidualArgs& a, const DepthwisePart<float>& s) {
  return std::ptrdiff_t{s.band_rows} * a.out_w * kStripBlock;
}
[[maybe_unused]] inline float* band_at(const InvertedResidualArgs& a,
                                       const DepthwisePart<float>& s) {
  return a.band + s.block * band_plane(a, s) + std::ptrdiff_t{s.row} * a.out_w * kStripBlock;
}

// Arguments to expand rows of the map from `row` on to rows of the strip at `y`.
inline ProductArgs expansion(const InvertedResidualArgs& a, const StripPart& part, std::int32_t row,
                             std::int32_t rows, float* y) {
  const StripClamp clamp = clamp_of(a.expand.activation);
  const std::int32_t in_blocks = (a.in_c + 7) / 8;
  ProductArgs product{};
  product.x = a.x + std::ptrdiff_t{row} * a.in_w * kStripBlock;
  product.x_plane_elems = std::ptrdiff_t{a.in_h} * a.in_w * kStripBlock;
  product.in_blocks = in_blocks;
  product.pixels = rows * a.in_w;
  const std::ptrdiff_t channel = std::ptrdiff_t{part.first} * kStripBlock;
  product.weights = a.expand.weights + channel * in_blocks * kStripBlock;
  product.bias = a.expand.bias + channel;
  product.out_blocks = part.count;
  product.low = clamp.low;
  product.high = clamp.high;
  product.y = y;
  product.y_rows = {kFloatPanel, kStripBlock, part.panel_elems, a.in_w,
                    part.row_elems - std::ptrdiff_t{a.in_w} * kFloatPanel};
  product.fp32_weights = a.fp32_weights;
  return product;
}

// Arguments to project `rows` rows of the band to output rows from `first` on.
inline ProductArgs projection(const InvertedResidualArgs& a, std::int32_t first,
                              std::int32_t rows) {
  const StripClamp clamp = clamp_of(a.project.activation);
  const std::ptrdiff_t plane = std::ptrdiff_t{a.out_h} * a.out_w * kStripBlock;
  ProductArgs product{};
  product.x = a.band;
  product.x_plane_elems = std::ptrdiff_t{rows} * a.out_w * kStripBlock;
  product.in_blocks = (a.hidden_c + 7) / 8;
  product.pixels = rows * a.out_w;
  product.weights = a.project.weights;
  product.bias = a.project.bias;
  product.out_blocks = (a.out_c + 7) / 8;
  product.low = clamp.low;
  product.high = clamp.high;
  product.y = a.y + std::ptrdiff_t{first} * a.out_w * kStripBlock;
  product.y_rows = {kStripBlock, plane, 2 * plane, 0x7FFFFFFF, 0};
  product.fp32_weights = a.fp32_weights;
  if (a.residual != nullptr) {
    const std::ptrdiff_t residual_plane = std::ptrdiff_t{a.residual_h} * a.residual_w * kStripBlock;
    const std::ptrdiff_t pixel =
        std::ptrdiff_t{first + a.residual_top} * a.residual_w + a.residual_left;
    product.residual = a.residual + pixel * kStripBlock;
    product.residual_rows = {kStripBlock, residual_plane, 2 * residual_plane, a.out_w,
                             std::ptrdiff_t{a.residual_w - a.out_w} * kStripBlock};
  }
  return product;
}

// Copies rows of the map to rows of the strip. `load(x, y)` copies 8 floats from x to y.
template <class Load>
void copy_rows(const InvertedResidualArgs& a, const StripPart& part, std::int32_t row,
               std::int32_t rows, float* y, Load load) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kStripBlock;
  const std::ptrdiff_t pixel = std::ptrdiff_t{row} * a.in_w;
  for (std::int32_t block = 0; block < part.count; ++block) {
    const float* x = a.x + (part.first + block) * plane + pixel * kStripBlock;
    float* to = y + block / 2 * part.panel_elems + std::ptrdiff_t{block % 2} * kStripBlock;
    for (std::int32_t i = 0; i < rows; ++i, to += part.row_elems) {
      for (std::ptrdiff_t column = 0; column < a.in_w; ++column, x += kStripBlock) {
        load(x, to + column * kFloatPanel);
      }
    }
  }
}

template <class Tier>
class FloatStrips {
 public:
  using Value = float;
  static constexpr std::int32_t kPanel = kFloatPanel;

  explicit FloatStrips(const InvertedResidualArgs& args) : a_(args) {}

  void begin(std::int32_t, std::int32_t) {}
  void expand(const StripPart& part, std::int32_t row, std::int32_t rows, float* y) const {
    Tier::multiply(expansion(a_, part, row, rows, y));
  }
  void copy(const StripPart& part, std::int32_t row, std::int32_t rows, float* y) const {
    copy_rows(a_, part, row, rows, y, &Tier::load);
  }
  void depthwise(const DepthwisePart<float>& s) const { Tier::depthwise(a_, s); }
  void project(std::int32_t first, std::int32_t rows) const {
    Tier::multiply(projection(a_, first, rows));
  }

 private:
  const InvertedResidualArgs& a_;
};

}  // namespace
}  // namespace mien::kernels
