// The order of work of a fused block, the same for every tier: bands, in them strips of channels,
// in these rows. A tier brings what it does with them:
//   multiply(const ProductArgs&)                  expands and projects
//   slide(args, Slide)                            rows of one strip to rows of the band
//   load(x, y)                                    8 floats from x to y
// Everything has internal linkage: each tier compiles its own.
#pragma once

#include <algorithm>

#include "kernels/common/product.h"
#include "kernels/inverted_residual/inverted_residual.h"

namespace mien::kernels {
namespace {

inline constexpr std::int32_t kStripBlock = 8;
inline constexpr std::int32_t kStripPanel = 16;

struct StripClamp {
  float low, high;
};

inline StripClamp clamp_of(const ActivationSpec& activation) {
  constexpr float kInfinity = __builtin_inff();
  switch (activation.kind) {
    case Activation::kRelu:
      return {0.0f, kInfinity};
    case Activation::kRelu6:
      return {0.0f, 6.0f};
    case Activation::kClamp01:
      return {0.0f, 1.0f};
    default:
      return {-kInfinity, kInfinity};
  }
}

// Rows of outputs from one strip: what the depthwise part of a tier needs to know.
struct Slide {
  const float* x;                // the strip's first row, of a panel of 16 channels
  std::ptrdiff_t x_row_elems;    // from row to row; pixels are 16 floats apart
  float* y;                      // first pixel, lower 8 channels
  std::ptrdiff_t y_plane_elems;  // from the lower 8 channels to the upper
  std::int32_t rows;
  std::int32_t block;  // first block of 8 channels
  bool both;           // the upper 8 channels exist
  StripClamp clamp;
};

template <class Tier>
class InvertedResidual {
 public:
  explicit InvertedResidual(const InvertedResidualArgs& args)
      : a_(args),
        hidden_blocks_((args.hidden_c + 7) / 8),
        row_elems_(std::ptrdiff_t{args.strip_w} * kStripPanel),
        panel_elems_(row_elems_ * args.strip_rows) {}

  void run() {
    clear(a_.strip, panel_elems_ * (a_.strip_channels / kStripPanel));
    for (std::int32_t first = 0; first < a_.out_h; first += a_.band_rows) {
      const std::int32_t rows = std::min(a_.band_rows, a_.out_h - first);
      const std::int32_t step = a_.strip_channels / kStripBlock;
      for (std::int32_t block = 0; block < hidden_blocks_; block += step) {
        make_strips({block, std::min(step, hidden_blocks_ - block)}, first, rows);
      }
      project(first, rows);
    }
  }

 private:
  struct Blocks {
    std::int32_t first, count;
    [[nodiscard]] std::int32_t panels() const { return (count + 1) / 2; }
  };

  static void clear(float* at, std::ptrdiff_t elems) {
    for (std::ptrdiff_t i = 0; i < elems; ++i) {
      at[i] = 0.0f;
    }
  }

  // `rows` rows of the band from output row `first` on; the strip moves down as it goes.
  void make_strips(Blocks blocks, std::int32_t first, std::int32_t rows) const {
    const std::int32_t at_once = (a_.strip_rows - a_.kernel_h) / a_.stride_h + 1;
    std::int32_t known = 0;  // rows of the strip that are made already
    for (std::int32_t row = 0; row < rows; row += at_once) {
      const std::int32_t count = std::min(at_once, rows - row);
      const std::int32_t needed = (count - 1) * a_.stride_h + a_.kernel_h;
      const std::int32_t top = (first + row) * a_.stride_h - a_.pad_top;
      fill(blocks, top, known, needed);
      slide(blocks, row, count, rows);
      known = std::max(0, needed - count * a_.stride_h);
      if (row + at_once < rows) {
        keep_last(blocks, needed, known);
      }
    }
  }

  // Strip rows [from, to), of which row 0 is row `top` of the map.
  void fill(Blocks blocks, std::int32_t top, std::int32_t from, std::int32_t to) const {
    const std::int32_t first = std::clamp(-top, from, to);
    const std::int32_t last = std::clamp(a_.in_h - top, first, to);
    for (std::int32_t panel = 0; panel < blocks.panels(); ++panel) {
      float* strip = a_.strip + panel * panel_elems_;
      clear(strip + from * row_elems_, (first - from) * row_elems_);
      clear(strip + last * row_elems_, (to - last) * row_elems_);
    }
    if (last > first) {
      float* at = a_.strip + first * row_elems_ + std::ptrdiff_t{a_.pad_left} * kStripPanel;
      const std::ptrdiff_t pixel = std::ptrdiff_t{top + first} * a_.in_w;
      a_.expand.weights != nullptr ? expand(blocks, pixel, last - first, at)
                                   : copy(blocks, pixel, last - first, at);
    }
  }

  void expand(Blocks blocks, std::ptrdiff_t pixel, std::int32_t rows, float* y) const {
    const StripClamp clamp = clamp_of(a_.expand.activation);
    const std::int32_t in_blocks = (a_.in_c + 7) / 8;
    ProductArgs product{};
    product.x = a_.x + pixel * kStripBlock;
    product.x_plane_elems = std::ptrdiff_t{a_.in_h} * a_.in_w * kStripBlock;
    product.in_blocks = in_blocks;
    product.pixels = rows * a_.in_w;
    const std::ptrdiff_t channel = std::ptrdiff_t{blocks.first} * kStripBlock;
    product.weights = a_.expand.weights + channel * in_blocks * kStripBlock;
    product.bias = a_.expand.bias + channel;
    product.out_blocks = blocks.count;
    product.low = clamp.low;
    product.high = clamp.high;
    product.y = y;
    product.y_rows = {kStripPanel, kStripBlock, panel_elems_, a_.in_w,
                      row_elems_ - std::ptrdiff_t{a_.in_w} * kStripPanel};
    product.wide = a_.wide;
    Tier::multiply(product);
  }

  void copy(Blocks blocks, std::ptrdiff_t pixel, std::int32_t rows, float* y) const {
    const std::ptrdiff_t plane = std::ptrdiff_t{a_.in_h} * a_.in_w * kStripBlock;
    for (std::int32_t block = 0; block < blocks.count; ++block) {
      const float* x = a_.x + (blocks.first + block) * plane + pixel * kStripBlock;
      float* to = y + block / 2 * panel_elems_ + std::ptrdiff_t{block % 2} * kStripBlock;
      for (std::int32_t row = 0; row < rows; ++row, to += row_elems_) {
        for (std::ptrdiff_t column = 0; column < a_.in_w; ++column, x += kStripBlock) {
          Tier::load(x, to + column * kStripPanel);
        }
      }
    }
  }

  // Output rows [row, row + count) of a band of `rows`.
  void slide(Blocks blocks, std::int32_t row, std::int32_t count, std::int32_t rows) const {
    const std::ptrdiff_t plane = std::ptrdiff_t{rows} * a_.out_w * kStripBlock;
    for (std::int32_t panel = 0; panel < blocks.panels(); ++panel) {
      const std::int32_t block = blocks.first + 2 * panel;
      float* y = a_.band + block * plane + std::ptrdiff_t{row} * a_.out_w * kStripBlock;
      Tier::slide(a_, Slide{a_.strip + panel * panel_elems_, row_elems_, y, plane, count, block,
                            2 * panel + 1 < blocks.count, clamp_of(a_.slide.activation)});
    }
  }

  // The last `count` of `rows` strip rows become the first.
  void keep_last(Blocks blocks, std::int32_t rows, std::int32_t count) const {
    for (std::int32_t panel = 0; panel < blocks.panels(); ++panel) {
      float* strip = a_.strip + panel * panel_elems_;
      const float* from = strip + (rows - count) * row_elems_;
      for (std::ptrdiff_t i = 0; i < count * row_elems_; i += kStripBlock) {
        Tier::load(from + i, strip + i);
      }
    }
  }

  void project(std::int32_t first, std::int32_t rows) const {
    const StripClamp clamp = clamp_of(a_.project.activation);
    const std::ptrdiff_t plane = std::ptrdiff_t{a_.out_h} * a_.out_w * kStripBlock;
    ProductArgs product{};
    product.x = a_.band;
    product.x_plane_elems = std::ptrdiff_t{rows} * a_.out_w * kStripBlock;
    product.in_blocks = hidden_blocks_;
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

  const InvertedResidualArgs& a_;
  std::int32_t hidden_blocks_;
  std::ptrdiff_t row_elems_, panel_elems_;
};

}  // namespace
}  // namespace mien::kernels
