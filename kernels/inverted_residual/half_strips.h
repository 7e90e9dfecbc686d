// The strips of tiers that compute in half precision. A tier supplies
//   kPanel                            channels per panel of strips and bands
//   half_input(x, plane, blocks, y)   converts up to a panel of blocks, `plane` floats apart
//   depthwise(args, part, y)          computes rows of the band
//   multiply_to_strip(product, to), multiply_to_map(product, to, fp32_weights)
#pragma once

#include "kernels/inverted_residual/half_product.h"
#include "kernels/inverted_residual/strips.h"

namespace mien::kernels {
namespace {

// The block's input in half precision and the band: [panel][pixel][kPanel].
template <class Tier>
class HalfStrips {
 public:
  using Value = Half;
  static constexpr std::int32_t kPanel = Tier::kPanel;

  [[nodiscard]] static bool can_run(const InvertedResidualArgs& args) {
    return has_short_half_sums(args.expand.weights != nullptr ? args.in_c : 0, args.kernel_h,
                               args.kernel_w);
  }

  explicit HalfStrips(const InvertedResidualArgs& args)
      : a_(args),
        x_(reinterpret_cast<Half*>(args.half_input)),
        band_(reinterpret_cast<Half*>(args.band)) {}

  void begin(std::int32_t first, std::int32_t rows) {
    if (a_.expand.weights == nullptr) {
      return;
    }
    first_row_ = first;
    x_panel_elems_ = std::ptrdiff_t{rows} * a_.in_w * kPanel;
    const std::int32_t blocks = blocks_of(a_.in_c);
    for (std::int32_t block = 0; block < blocks; block += kBlocks) {
      convert_row(block, blocks - block, first, rows * a_.in_w,
                  x_ + block / kBlocks * x_panel_elems_);
    }
  }

  void expand(const StripPart& part, std::int32_t row, std::int32_t rows, Half* y) const {
    const StripClamp clamp = clamp_of(a_.expand.activation);
    const std::ptrdiff_t channel = std::ptrdiff_t{part.first} * kStripBlock;
    HalfProduct product{};
    product.x = x_ + std::ptrdiff_t{row - first_row_} * a_.in_w * kPanel;
    product.x_panel_elems = x_panel_elems_;
    product.in_blocks = blocks_of(a_.in_c);
    product.pixels = rows * a_.in_w;
    product.weights = a_.expand.weights + channel * product.in_blocks * kStripBlock;
    product.bias = a_.expand.bias + channel;
    product.out_blocks = part.count;
    product.low = clamp.low;
    product.high = clamp.high;
    Tier::multiply_to_strip(product, {y, part.panel_elems, part.row_elems, a_.in_w});
  }

  void copy(const StripPart& part, std::int32_t row, std::int32_t rows, Half* y) const {
    for (std::int32_t block = 0; block < part.count; block += kBlocks) {
      for (std::int32_t i = 0; i < rows; ++i) {
        convert_row(part.first + block, part.count - block, row + i, a_.in_w,
                    y + block / kBlocks * part.panel_elems + i * part.row_elems);
      }
    }
  }

  void depthwise(const DepthwisePart<Half>& s) const {
    const std::ptrdiff_t row = std::ptrdiff_t{s.block / kBlocks} * s.band_rows + s.row;
    Tier::depthwise(a_, s, band_ + row * a_.out_w * kPanel);
  }

  void project(std::int32_t first, std::int32_t rows) const {
    const StripClamp clamp = clamp_of(a_.project.activation);
    HalfProduct product{};
    product.x = band_;
    product.x_panel_elems = std::ptrdiff_t{rows} * a_.out_w * kPanel;
    product.in_blocks = blocks_of(a_.hidden_c);
    product.pixels = rows * a_.out_w;
    product.weights = a_.project.weights;
    product.bias = a_.project.bias;
    product.out_blocks = blocks_of(a_.out_c);
    product.low = clamp.low;
    product.high = clamp.high;
    MapRows to{};
    to.y = a_.y + std::ptrdiff_t{first} * a_.out_w * kStripBlock;
    to.plane_elems = std::ptrdiff_t{a_.out_h} * a_.out_w * kStripBlock;
    to.row_pixels = a_.out_w;
    if (a_.residual != nullptr) {
      const std::ptrdiff_t pixel =
          std::ptrdiff_t{first + a_.residual_top} * a_.residual_w + a_.residual_left;
      to.residual = a_.residual + pixel * kStripBlock;
      to.residual_plane_elems = std::ptrdiff_t{a_.residual_h} * a_.residual_w * kStripBlock;
      to.residual_row_elems = std::ptrdiff_t{a_.residual_w} * kStripBlock;
    }
    Tier::multiply_to_map(product, to, a_.fp32_weights);
  }

 private:
  static constexpr std::int32_t kBlocks = kPanel / kStripBlock;  // blocks per panel

  static std::int32_t blocks_of(std::int32_t channels) { return (channels + 7) / kStripBlock; }

  // Converts up to a panel of blocks of `pixels` pixels, from the start of a map row on.
  void convert_row(std::int32_t block, std::int32_t blocks, std::int32_t row, std::int32_t pixels,
                   Half* y) const {
    const std::ptrdiff_t plane = std::ptrdiff_t{a_.in_h} * a_.in_w * kStripBlock;
    const float* x = a_.x + block * plane + std::ptrdiff_t{row} * a_.in_w * kStripBlock;
    for (std::int32_t p = 0; p < pixels; ++p, x += kStripBlock, y += kPanel) {
      Tier::half_input(x, plane, blocks, y);
    }
  }

  const InvertedResidualArgs& a_;
  Half* x_;  // starts with row `first_row_`
  Half* band_;
  std::int32_t first_row_ = 0;
  std::ptrdiff_t x_panel_elems_ = 0;
};

}  // namespace
}  // namespace mien::kernels
