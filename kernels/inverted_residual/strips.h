// The order of work of a fused block, the same for every tier: bands, in them strips of channels,
// in these rows. A tier brings what it does with them:
//
//   Value      what strips and bands are made of: float, or std::uint16_t for fp16
//   kPanel     channels that lie together in a strip
//   Tier(args)
//   begin(first, rows)                    those rows of the map are about to be expanded
//   expand(part, row, rows, to), copy(..) rows of the map to rows of the strip
//   slide(Slide)                          rows of one panel of the strip to rows of the band
//   project(first, rows)                  the band to these rows of the result
//
// Everything has internal linkage: each tier compiles its own.
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

// Blocks of 8 channels that are in the strip together, and the size of a panel of it.
struct StripPart {
  std::int32_t first, count;
  std::ptrdiff_t row_elems, panel_elems;
};

// Rows of outputs from one panel: what the depthwise part of a tier needs to know.
template <class Value>
struct DepthwisePart {
  const Value* x;              // the strip's first row; pixels are kPanel values apart
  std::ptrdiff_t x_row_elems;  // from row to row
  std::int32_t block, blocks;  // first block of 8 channels; how many of them there are
  std::int32_t row, rows;      // of the band, to be written
  std::int32_t band_rows;      // that the band has now
  StripClamp clamp;
};

template <class Tier>
class InvertedResidual {
 public:
  explicit InvertedResidual(const InvertedResidualArgs& args)
      : a_(args),
        tier_(args),
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

  // `rows` rows of the band from output row `first` on, `step` blocks of channels at a time.
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

  // The strip moves down as it goes.
  void make_strips(const StripPart& part, std::int32_t first, std::int32_t rows) {
    const std::int32_t at_once = (a_.strip_rows - a_.kernel_h) / a_.stride_h + 1;
    std::int32_t known = 0;  // rows of the strip that are made already
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

  // Strip rows [from, to), of which row 0 is row `top` of the map.
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

  // The last `count` of `rows` strip rows become the first.
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
