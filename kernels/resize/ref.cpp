// The reference kernel of resize.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

// A position as a fraction, so that halves are exact.
struct Place {
  std::int64_t above, below;  // numerator, denominator
};

Place place(Grid grid, std::int32_t i, std::int32_t in, std::int32_t out) {
  switch (grid) {
    case Grid::kHalfPixel:
      return {(2 * std::int64_t{i} + 1) * in - out, 2 * std::int64_t{out}};
    case Grid::kAsymmetric:
      return {std::int64_t{i} * in, out};
    case Grid::kAlignCorners:
      break;
  }
  return {std::int64_t{i} * (in - 1), out > 1 ? out - 1 : 1};
}

std::int64_t floor_of(std::int64_t above, std::int64_t below) {
  return above >= 0 ? above / below : -((below - 1 - above) / below);
}

std::int32_t nearest(Sampling sampling, Place at, std::int32_t in) {
  std::int64_t row = 0;
  switch (sampling) {
    case Sampling::kRoundHalfDown:
      row = -floor_of(at.below - 2 * at.above, 2 * at.below);
      break;
    case Sampling::kRoundHalfUp:
      row = floor_of(2 * at.above + at.below, 2 * at.below);
      break;
    case Sampling::kCeil:
      row = -floor_of(-at.above, at.below);
      break;
    default:
      row = floor_of(at.above, at.below);
  }
  return static_cast<std::int32_t>(std::clamp(row, std::int64_t{0}, std::int64_t{in} - 1));
}

struct Neighbours {
  std::int32_t low, high;
  double weight;  // weight of `high`
};

Neighbours between(const ResizeArgs& a, std::int32_t i, std::int32_t in, std::int32_t out) {
  const Place at = place(a.grid, i, in, out);
  if (a.sampling != Sampling::kBilinear) {
    const std::int32_t row = nearest(a.sampling, at, in);
    return {row, row, 0.0};
  }
  const double exact = static_cast<double>(at.above) / static_cast<double>(at.below);
  const double inside = std::clamp(exact, 0.0, static_cast<double>(in - 1));
  const auto low = static_cast<std::int32_t>(inside);
  return {low, std::min(low + 1, in - 1), inside - low};
}

}  // namespace

void resize(const ResizeArgs& a) {
  const std::ptrdiff_t in_pixels = std::ptrdiff_t{a.in_h} * a.in_w;
  const std::ptrdiff_t out_pixels = std::ptrdiff_t{a.out_h} * a.out_w;
  for (std::int32_t c = 0; c < blocks_of(a.channels) * kBlock; ++c) {
    for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
      const Neighbours row = between(a, oy, a.in_h, a.out_h);
      for (std::int32_t ox = 0; ox < a.out_w; ++ox) {
        const Neighbours column = between(a, ox, a.in_w, a.out_w);
        const auto at = [&](std::int32_t y, std::int32_t x) {
          return static_cast<double>(a.x[blocked(c, std::ptrdiff_t{y} * a.in_w + x, in_pixels)]);
        };
        const auto along = [&](std::int32_t y) {
          return at(y, column.low) * (1.0 - column.weight) + at(y, column.high) * column.weight;
        };
        const double value = along(row.low) * (1.0 - row.weight) + along(row.high) * row.weight;
        a.y[blocked(c, std::ptrdiff_t{oy} * a.out_w + ox, out_pixels)] = static_cast<float>(value);
      }
    }
  }
}

}  // namespace mien::kernels::ref
