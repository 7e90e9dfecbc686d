// Overlapping squares that cover the region of interest of an image.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tracker/geometry/geometry.h"

namespace mien::tracker {

class Tiles {
 public:
  // All in pixels of the image. Any window of side `overlap` or less lies within one tile. A tile
  // larger than the area is centred on it.
  Tiles(const Rect& area, float side, float overlap)
      : area_(area),
        side_(side),
        columns_(number(area.width, side, overlap)),
        rows_(number(area.height, side, overlap)) {}

  [[nodiscard]] std::uint32_t count() const { return columns_ * rows_; }

  [[nodiscard]] Square square(std::uint32_t i) const {
    return {{area_.corner.x + middle(i % columns_, columns_, area_.width),
             area_.corner.y + middle(i / columns_, rows_, area_.height)},
            side_};
  }

 private:
  [[nodiscard]] static std::uint32_t number(float length, float side, float overlap) {
    const float more = std::ceil((length - side) / (side - overlap));
    return 1 + static_cast<std::uint32_t>(std::max(more, 0.0f));
  }

  // Position of tile `i` of `n` along an axis; the first and the last touch the borders of the
  // area.
  [[nodiscard]] float middle(std::uint32_t i, std::uint32_t n, float length) const {
    if (n == 1) {
      return length / 2;
    }
    const float step = (length - side_) / static_cast<float>(n - 1);
    return side_ / 2 + step * static_cast<float>(i);
  }

  Rect area_;
  float side_;
  std::uint32_t columns_;
  std::uint32_t rows_;
};

}  // namespace mien::tracker
