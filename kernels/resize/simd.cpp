// The resize kernel of all vector tiers: a plain loop over the 8 channels of a block, which
// compilers vectorize.
#include "kernels/common/lanes.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Two rows (or columns) and the weight of the second.
struct Neighbours {
  std::int32_t low, high;
  float weight;
};

// Iterates over the output's rows (or columns). Every rounding is the floor of a fraction whose
// numerator grows by a constant from row to row, so that only the first row needs a division.
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

  [[nodiscard]] Neighbours place() const {
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
  std::int64_t step_ = 0, below_ = 1;  // numerator's increment, denominator
  std::int64_t row_ = 0, rest_ = 0;    // the fraction is row_ + rest_ / below_
  std::int64_t last_;
  bool bilinear_ = false;
};

using Lanes = float[kBlockLanes];

// Stores results from registers, because the compiler cannot know that x and y do not overlap.
inline void put(const Lanes& result, float* y) {
  for (int i = 0; i < kBlockLanes; ++i) {
    y[i] = result[i];
  }
}

inline void interpolate(const float* a, const float* b, float weight, Lanes& result) {
  for (int i = 0; i < kBlockLanes; ++i) {
    result[i] = a[i] * (1.0f - weight) + b[i] * weight;
  }
}

inline void resize_pixel(const float* above, const float* below, const Neighbours& row,
                         const Neighbours& column, float* y) {
  const std::ptrdiff_t left = std::ptrdiff_t{column.low} * kBlockLanes;
  const std::ptrdiff_t right = std::ptrdiff_t{column.high} * kBlockLanes;
  Lanes up, down, result;
  interpolate(above + left, above + right, column.weight, up);
  interpolate(below + left, below + right, column.weight, down);
  interpolate(up, down, row.weight, result);
  put(result, y);
}

// Copies the nearest pixel; multiplying by weights 1 and 0 would not preserve NaN and infinity.
inline void copy_pixel(const float* x, const Neighbours& column, float* y) {
  Lanes result;
  const float* from = x + std::ptrdiff_t{column.low} * kBlockLanes;
  for (int i = 0; i < kBlockLanes; ++i) {
    result[i] = from[i];
  }
  put(result, y);
}

inline void resize_any(const ResizeArgs& a) {
  const std::ptrdiff_t row_elems = std::ptrdiff_t{a.in_w} * kBlockLanes;
  const std::ptrdiff_t in_plane = a.in_h * row_elems;
  const std::ptrdiff_t out_plane = std::ptrdiff_t{a.out_h} * a.out_w * kBlockLanes;
  Walk rows(a.grid, a.sampling, a.in_h, a.out_h);
  for (std::int32_t oy = 0; oy < a.out_h; ++oy, rows.next()) {
    const Neighbours row = rows.place();
    Walk columns(a.grid, a.sampling, a.in_w, a.out_w);
    for (std::int32_t ox = 0; ox < a.out_w; ++ox, columns.next()) {
      const Neighbours column = columns.place();
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

void resize(const ResizeArgs& args) { resize_any(args); }

}  // namespace mien::kernels::MIEN_TIER
