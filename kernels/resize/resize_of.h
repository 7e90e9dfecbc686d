// The loop of all tiers, which the compiler makes vectors of: 8 channels are independent. Each tier
// has a copy with internal linkage.
#pragma once

#include "kernels/common/lanes.h"
#include "kernels/resize/resize.h"

namespace mien::kernels {
namespace {

// Two rows (or columns) and how much the second counts.
struct Between {
  std::int32_t low, high;
  float share;
};

// Walks over the output's rows (or columns). All ways of rounding are the floor of a fraction whose
// numerator grows by the same step from row to row: no division but the first.
class Walk {
 public:
  Walk(Grid grid, Sampling sampling, std::int32_t in, std::int32_t out) : last_(in - 1) {
    std::int64_t first = 0;
    if (grid == Grid::kHalfPixel) {
      first = std::int64_t{in} - out;
      step_ = 2 * std::int64_t{in};
      below_ = 2 * std::int64_t{out};
    } else if (grid == Grid::kAsymmetric) {
      step_ = in;
      below_ = out;
    } else {
      step_ = in - 1;
      below_ = out > 1 ? out - 1 : 1;
    }
    if (sampling == Sampling::kRoundHalfDown || sampling == Sampling::kRoundHalfUp) {
      first = 2 * first + below_ - (sampling == Sampling::kRoundHalfDown ? 1 : 0);
      step_ *= 2;
      below_ *= 2;
    } else if (sampling == Sampling::kCeil) {
      first += below_ - 1;
    }
    bilinear_ = sampling == Sampling::kBilinear;
    row_ = first / below_ - (first % below_ < 0 ? 1 : 0);
    rest_ = first - row_ * below_;
  }

  [[nodiscard]] Between place() const {
    const std::int64_t inside = row_ < 0 ? 0 : row_ < last_ ? row_ : last_;
    const auto row = static_cast<std::int32_t>(inside);
    if (!bilinear_ || row_ < 0 || row_ >= last_) {
      return {row, row, 0.0f};
    }
    return {row, row + 1, static_cast<float>(rest_) / static_cast<float>(below_)};
  }

  void next() {
    for (rest_ += step_; rest_ >= below_; rest_ -= below_) {
      ++row_;
    }
  }

 private:
  std::int64_t step_ = 0, below_ = 1;  // numerator's step, denominator
  std::int64_t row_ = 0, rest_ = 0;    // the fraction is row + rest / below
  std::int64_t last_;
  bool bilinear_ = false;
};

using Lanes = float[kBlockLanes];

// Output and input do not overlap, which the compiler cannot know: what is made waits in registers.
inline void put(const Lanes& made, float* y) {
  for (int i = 0; i < kBlockLanes; ++i) {
    y[i] = made[i];
  }
}

inline void weigh(const float* a, const float* b, float share, Lanes& made) {
  for (int i = 0; i < kBlockLanes; ++i) {
    made[i] = a[i] * (1.0f - share) + b[i] * share;
  }
}

inline void resize_pixel(const float* above, const float* below, const Between& row,
                         const Between& column, float* y) {
  const std::ptrdiff_t left = std::ptrdiff_t{column.low} * kBlockLanes;
  const std::ptrdiff_t right = std::ptrdiff_t{column.high} * kBlockLanes;
  Lanes up, down, made;
  weigh(above + left, above + right, column.share, up);
  weigh(below + left, below + right, column.share, down);
  weigh(up, down, row.share, made);
  put(made, y);
}

// The nearest pixel is copied, not weighted with nothing: that is exact for whatever it holds.
inline void copy_pixel(const float* x, const Between& column, float* y) {
  Lanes made;
  const float* from = x + std::ptrdiff_t{column.low} * kBlockLanes;
  for (int i = 0; i < kBlockLanes; ++i) {
    made[i] = from[i];
  }
  put(made, y);
}

inline void resize_any(const ResizeArgs& a) {
  const std::ptrdiff_t row_elems = std::ptrdiff_t{a.in_w} * kBlockLanes;
  const std::ptrdiff_t in_plane = a.in_h * row_elems;
  const std::ptrdiff_t out_plane = std::ptrdiff_t{a.out_h} * a.out_w * kBlockLanes;
  Walk rows(a.grid, a.sampling, a.in_h, a.out_h);
  for (std::int32_t oy = 0; oy < a.out_h; ++oy, rows.next()) {
    const Between row = rows.place();
    Walk columns(a.grid, a.sampling, a.in_w, a.out_w);
    for (std::int32_t ox = 0; ox < a.out_w; ++ox, columns.next()) {
      const Between column = columns.place();
      const float* x = a.x;
      float* y = a.y + (std::ptrdiff_t{oy} * a.out_w + ox) * kBlockLanes;
      for (std::int32_t block = 0; block < blocks_for(a.channels); ++block) {
        if (a.sampling == Sampling::kBilinear) {
          resize_pixel(x + row.low * row_elems, x + row.high * row_elems, row, column, y);
        } else {
          copy_pixel(x + row.low * row_elems, column, y);
        }
        x += in_plane;
        y += out_plane;
      }
    }
  }
}

}  // namespace
}  // namespace mien::kernels
