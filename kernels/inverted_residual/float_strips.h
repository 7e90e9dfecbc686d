// What tiers that compute in fp32 do with strips, but for the depthwise part. Such a tier brings
//   multiply(const ProductArgs&)   expands and projects
//   load(x, y)                     8 floats from x to y
#pragma once

#include "kernels/common/product.h"
#include "kernels/inverted_residual/strips.h"

namespace mien::kernels {
namespace {

// Where the band has the first pixel of a slide, lower 8 channels, and from them to the next 8.
inline std::ptrdiff_t band_plane(const InvertedResidualArgs& a, const Slide<float>& s) {
  return std::ptrdiff_t{s.band_rows} * a.out_w * kStripBlock;
}
inline float* band_at(const InvertedResidualArgs& a, const Slide<float>& s) {
  return a.band + s.block * band_plane(a, s) + std::ptrdiff_t{s.row} * a.out_w * kStripBlock;
}

template <class Tier>
class FloatStrips {
 public:
  using Value = float;
  static constexpr std::int32_t kPanel = 16;

  explicit FloatStrips(const InvertedResidualArgs& args) : a_(args) {}

  void begin(std::int32_t, std::int32_t) {}

  void expand(const StripPart& part, std::int32_t row, std::int32_t rows, float* y) const {
    const StripClamp clamp = clamp_of(a_.expand.activation);
    const std::int32_t in_blocks = (a_.in_c + 7) / 8;
    ProductArgs product{};
    product.x = a_.x + std::ptrdiff_t{row} * a_.in_w * kStripBlock;
    product.x_plane_elems = std::ptrdiff_t{a_.in_h} * a_.in_w * kStripBlock;
    product.in_blocks = in_blocks;
    product.pixels = rows * a_.in_w;
    const std::ptrdiff_t channel = std::ptrdiff_t{part.first} * kStripBlock;
    product.weights = a_.expand.weights + channel * in_blocks * kStripBlock;
    product.bias = a_.expand.bias + channel;
    product.out_blocks = part.count;
    product.low = clamp.low;
    product.high = clamp.high;
    product.y = y;
    product.y_rows = {kPanel, kStripBlock, part.panel_elems, a_.in_w,
                      part.row_elems - std::ptrdiff_t{a_.in_w} * kPanel};
    product.wide = a_.wide;
    Tier::multiply(product);
  }

  void copy(const StripPart& part, std::int32_t row, std::int32_t rows, float* y) const {
    const std::ptrdiff_t plane = std::ptrdiff_t{a_.in_h} * a_.in_w * kStripBlock;
    const std::ptrdiff_t pixel = std::ptrdiff_t{row} * a_.in_w;
    for (std::int32_t block = 0; block < part.count; ++block) {
      const float* x = a_.x + (part.first + block) * plane + pixel * kStripBlock;
      float* to = y + block / 2 * part.panel_elems + std::ptrdiff_t{block % 2} * kStripBlock;
      for (std::int32_t i = 0; i < rows; ++i, to += part.row_elems) {
        for (std::ptrdiff_t column = 0; column < a_.in_w; ++column, x += kStripBlock) {
          Tier::load(x, to + column * kPanel);
        }
      }
    }
  }

  void slide(const Slide<float>& s) const { Tier::slide(a_, s); }

  void project(std::int32_t first, std::int32_t rows) const {
    const StripClamp clamp = clamp_of(a_.project.activation);
    const std::ptrdiff_t plane = std::ptrdiff_t{a_.out_h} * a_.out_w * kStripBlock;
    ProductArgs product{};
    product.x = a_.band;
    product.x_plane_elems = std::ptrdiff_t{rows} * a_.out_w * kStripBlock;
    product.in_blocks = (a_.hidden_c + 7) / 8;
    product.pixels = rows * a_.out_w;
    product.weights = a_.project.weights;
    product.bias = a_.project.bias;
    product.out_blocks = (a_.out_c + 7) / 8;
    product.low = clamp.low;
    product.high = clamp.high;
    product.y = a_.y + std::ptrdiff_t{first} * a_.out_w * kStripBlock;
    product.y_rows = {kStripBlock, plane, 2 * plane, 0x7FFFFFFF, 0};
    product.wide = a_.wide;
    if (a_.residual != nullptr) {
      const std::ptrdiff_t residual_plane =
          std::ptrdiff_t{a_.residual_h} * a_.residual_w * kStripBlock;
      const std::ptrdiff_t pixel =
          std::ptrdiff_t{first + a_.residual_top} * a_.residual_w + a_.residual_left;
      product.residual = a_.residual + pixel * kStripBlock;
      product.residual_rows = {kStripBlock, residual_plane, 2 * residual_plane, a_.out_w,
                               std::ptrdiff_t{a_.residual_w - a_.out_w} * kStripBlock};
    }
    Tier::multiply(product);
  }

 private:
  const InvertedResidualArgs& a_;
};

}  // namespace
}  // namespace mien::kernels
