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

inline std::int32_t half_blocks(std::int32_t channels) {
  return (channels + kStripBlock - 1) / kStripBlock;
}

// Arguments to expand `rows` rows of the map, without their values.
inline HalfProduct half_expansion(const InvertedResidualArgs& a, const StripPart& part,
                                  std::int32_t rows) {
  const StripClamp clamp = clamp_of(a.expand.activation);
  const std::ptrdiff_t channel = std::ptrdiff_t{part.first} * kStripBlock;
  HalfProduct product{};
  product.in_blocks = half_blocks(a.in_c);
  product.pixels = rows * a.in_w;
  product.weights = a.expand.weights + channel * product.in_blocks * kStripBlock;
  product.bias = a.expand.bias + channel;
  product.out_blocks = part.count;
  product.low = clamp.low;
  product.high = clamp.high;
  return product;
}

// The rows of the strip that the expansion writes.
inline StripRows strip_rows(const InvertedResidualArgs& a, const StripPart& part, Half* y) {
  return {y, part.panel_elems, part.row_elems, a.in_w};
}

// Arguments to project `rows` rows of the band, without their values.
inline HalfProduct half_projection(const InvertedResidualArgs& a, std::int32_t rows) {
  const StripClamp clamp = clamp_of(a.project.activation);
  HalfProduct product{};
  product.in_blocks = half_blocks(a.hidden_c);
  product.pixels = rows * a.out_w;
  product.weights = a.project.weights;
  product.bias = a.project.bias;
  product.out_blocks = half_blocks(a.out_c);
  product.low = clamp.low;
  product.high = clamp.high;
  return product;
}

// The output rows from `first` on.
inline MapRows map_rows(const InvertedResidualArgs& a, std::int32_t first) {
  MapRows to{};
  to.y = a.y + std::ptrdiff_t{first} * a.out_w * kStripBlock;
  to.plane_elems = std::ptrdiff_t{a.out_h} * a.out_w * kStripBlock;
  to.row_pixels = a.out_w;
  if (a.residual != nullptr) {
    const std::ptrdiff_t pixel =
        std::ptrdiff_t{first + a.residual_top} * a.residual_w + a.residual_left;
    to.residual = a.residual + pixel * kStripBlock;
    to.residual_plane_elems = std::ptrdiff_t{a.residual_h} * a.residual_w * kStripBlock;
    to.residual_row_elems = std::ptrdiff_t{a.residual_w} * kStripBlock;
  }
  return to;
}

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
    const std::int32_t blocks = half_blocks(a_.in_c);
    for (std::int32_t block = 0; block < blocks; block += kBlocks) {
      convert_row(block, blocks - block, first, rows * a_.in_w,
                  x_ + block / kBlocks * x_panel_elems_);
    }
  }

  void expand(const StripPart& part, std::int32_t row, std::int32_t rows, Half* y) const {
    HalfProduct product = half_expansion(a_, part, rows);
    product.x = x_ + std::ptrdiff_t{row - first_row_} * a_.in_w * kPanel;
    product.x_panel_elems = x_panel_elems_;
    Tier::multiply_to_strip(product, strip_rows(a_, part, y));
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
    HalfProduct product = half_projection(a_, rows);
    product.x = band_;
    product.x_panel_elems = std::ptrdiff_t{rows} * a_.out_w * kPanel;
    Tier::multiply_to_map(product, map_rows(a_, first), a_.fp32_weights);
  }

 private:
  static constexpr std::int32_t kBlocks = kPanel / kStripBlock;  // blocks per panel

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
