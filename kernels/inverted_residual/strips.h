// The loops of a fused block, common to all tiers: over bands, over strips of channels in a band,
// and over rows in a strip. A tier supplies the operations:
//
//   Value      element type of strips and bands: float, or std::uint16_t for fp16
//   kPanel     contiguous channels in a strip
//   Tier(args)
//   begin(first, rows)                    called before these rows of the map are expanded
//   expand(part, row, rows, to), copy(..) write rows of the strip from rows of the map
//   depthwise(part)                       writes rows of the band from one panel of the strip
//   project(first, rows)                  writes these output rows from the band
//
// All code has internal linkage: each tier compiles its own copy.
#pragma once

#include <algorithm>

#include "kernels/inverted_residual/inverted_residual.h"

namespace mien::kernels {
namespace {

inline constexpr std::int32_t kStripBlock = 8;

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

// The blocks of 8 channels in the strip, and the strip's layout.
struct StripPart {
  std::int32_t first, count;
  std::ptrdiff_t row_elems, panel_elems;
};

// Arguments of the depthwise part: rows of outputs from one panel of the strip.
template <class Value>
struct DepthwisePart {
  const Value* x;              // the strip's first row; pixels are kPanel values apart
  std::ptrdiff_t x_row_elems;  // distance between rows
  std::int32_t block, blocks;  // first block of 8 channels; number of blocks
  std::int32_t row, rows;      // rows of the band to write
  std::int32_t band_rows;      // rows of the current band
  StripClamp clamp;
};

template <class Tier>
class InvertedResidual {
 public:
  explicit InvertedResidual(const InvertedResidualArgs& args)
      : InvertedResidual(args, Tier(args)) {}
  InvertedResidual(const InvertedResidualArgs& args, Tier tier)
      : a_(args),
        tier_(tier),
        strip_(reinterpret_cast<Value*>(args.strip)),
        row_elems_(std::ptrdiff_t{args.strip_w} * kPanel),
        panel_elems_(row_elems_ * args.strip_rows) {}

  void run() {
    constexpr auto kPanelFloats = static_cast<std::int32_t>(kPanel * sizeof(Value) / sizeof(float));
    const std::int32_t panels = a_.strip_channels / kPanelFloats;
    clear(strip_, panel_elems_ * panels);
    for (std::int32_t first = 0; first < a_.out_h; first += a_.band_rows) {
      make_band(first, std::min(a_.band_rows, a_.out_h - first), panels * kBlocks);
    }
  }

 private:
  using Value = typename Tier::Value;
  static constexpr std::int32_t kPanel = Tier::kPanel;
  static constexpr std::int32_t kBlocks = kPanel / kStripBlock;

  static std::int32_t panels_of(const StripPart& part) {
    return (part.count + kBlocks - 1) / kBlocks;
  }

  static void clear(Value* at, std::ptrdiff_t elems) {
    for (std::ptrdiff_t i = 0; i < elems; ++i) {
      at[i] = Value{};
    }
  }

  // Computes `rows` rows of the band from output row `first` on, `step` blocks of channels at a
  // time.
  void make_band(std::int32_t first, std::int32_t rows, std::int32_t step) {
    const std::int32_t blocks = (a_.hidden_c + kStripBlock - 1) / kStripBlock;
    const std::int32_t top = first * a_.stride_h - a_.pad_top;
    const std::int32_t bottom = top + (rows - 1) * a_.stride_h + a_.kernel_h;
    const std::int32_t begin = std::clamp(top, 0, a_.in_h);
    tier_.begin(begin, std::clamp(bottom, begin, a_.in_h) - begin);
    for (std::int32_t block = 0; block < blocks; block += step) {
      make_strips({block, std::min(step, blocks - block), row_elems_, panel_elems_}, first, rows);
    }
    tier_.project(first, rows);
  }

  // Computes the band's rows for one part, moving the strip downwards.
  void make_strips(const StripPart& part, std::int32_t first, std::int32_t rows) {
    const std::int32_t at_once = (a_.strip_rows - a_.kernel_h) / a_.stride_h + 1;
    std::int32_t known = 0;  // rows of the strip that are already computed
    for (std::int32_t row = 0; row < rows; row += at_once) {
      const std::int32_t count = std::min(at_once, rows - row);
      const std::int32_t needed = (count - 1) * a_.stride_h + a_.kernel_h;
      const std::int32_t top = (first + row) * a_.stride_h - a_.pad_top;
      fill(part, top, known, needed);
      for (std::int32_t panel = 0; panel < panels_of(part); ++panel) {
        tier_.depthwise(DepthwisePart<Value>{strip_ + panel * panel_elems_, row_elems_,
                                             part.first + panel * kBlocks,
                                             std::min(kBlocks, part.count - panel * kBlocks), row,
                                             count, rows, clamp_of(a_.depthwise.activation)});
      }
      known = std::max(0, needed - count * a_.stride_h);
      if (row + at_once < rows) {
        keep_last(part, needed, known);
      }
    }
  }

  // Fills strip rows [from, to), where row 0 is row `top` of the map.
  void fill(const StripPart& part, std::int32_t top, std::int32_t from, std::int32_t to) {
    const std::int32_t first = std::clamp(-top, from, to);
    const std::int32_t last = std::clamp(a_.in_h - top, first, to);
    for (std::int32_t panel = 0; panel < panels_of(part); ++panel) {
      Value* strip = strip_ + panel * panel_elems_;
      clear(strip + from * row_elems_, (first - from) * row_elems_);
      clear(strip + last * row_elems_, (to - last) * row_elems_);
    }
    if (last > first) {
      Value* at = strip_ + first * row_elems_ + std::ptrdiff_t{a_.pad_left} * kPanel;
      a_.expand.weights != nullptr ? tier_.expand(part, top + first, last - first, at)
                                   : tier_.copy(part, top + first, last - first, at);
    }
  }

  // Moves the last `count` of `rows` strip rows to the beginning.
  void keep_last(const StripPart& part, std::int32_t rows, std::int32_t count) {
    for (std::int32_t panel = 0; panel < panels_of(part); ++panel) {
      Value* strip = strip_ + panel * panel_elems_;
      const Value* from = strip + (rows - count) * row_elems_;
      for (std::ptrdiff_t i = 0; i < count * row_elems_; ++i) {
        strip[i] = from[i];
      }
    }
  }

  const InvertedResidualArgs& a_;
  Tier tier_;
  Value* strip_;
  std::ptrdiff_t row_elems_, panel_elems_;
};

}  // namespace
}  // namespace mien::kernels
