// Points, squares and affine maps in the image plane. Pixel (column, row) covers [column, column +
// 1) x [row, row + 1): its centre is at (column + 0.5, row + 0.5). y points down.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace mien::tracker {

struct Point {
  float x = 0.0f;
  float y = 0.0f;
};

inline bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

inline bool is_finite(Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }

// (x, y) -> (xx x + xy y + x0, yx x + yy y + y0)
struct Affine {
  float xx = 1.0f, xy = 0.0f, x0 = 0.0f;
  float yx = 0.0f, yy = 1.0f, y0 = 0.0f;

  [[nodiscard]] Point operator()(Point p) const {
    return {xx * p.x + xy * p.y + x0, yx * p.x + yy * p.y + y0};
  }
};

// p -> outer(inner(p))
[[nodiscard]] inline Affine compose(const Affine& outer, const Affine& inner) {
  const Point origin = outer({inner.x0, inner.y0});
  return {outer.xx * inner.xx + outer.xy * inner.yx,
          outer.xx * inner.xy + outer.xy * inner.yy,
          origin.x,
          outer.yx * inner.xx + outer.yy * inner.yx,
          outer.yx * inner.xy + outer.yy * inner.yy,
          origin.y};
}

// An axis-aligned rectangle, in pixels.
struct Rect {
  Point corner;  // top left
  float width = 0.0f;
  float height = 0.0f;

  [[nodiscard]] Point center() const { return {corner.x + width / 2, corner.y + height / 2}; }
  [[nodiscard]] float longer_side() const { return std::max(width, height); }
};

// An axis-aligned square, in pixels.
struct Square {
  Point center;
  float side = 0.0f;
};

}  // namespace mien::tracker
