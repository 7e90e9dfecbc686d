// A pointer that follows pixels in rows, for loops that keep it in registers.
#pragma once

#include "kernels/common/product_spot.h"

namespace mien::kernels {
namespace {

// Float is float or const float.
template <class Float>
class PixelPointer {
 public:
  PixelPointer() = default;
  PixelPointer(Float* map, const PixelRows& rows, std::int32_t first_panel, std::int32_t pixel)
      : at(map + Cursor(rows, pixel).at(first_panel)),
        half(rows.half_elems),
        panel(rows.panel_elems),
        step_(rows.pixel_elems),
        gap_(rows.row_gap_elems),
        column_(pixel % rows.row_pixels),
        columns_(rows.row_pixels) {}
  // Of a map that may be null, and then stays null.
  static PixelPointer optional(Float* map, const PixelRows& rows, std::int32_t first_panel,
                               std::int32_t pixel) {
    return map == nullptr ? PixelPointer() : PixelPointer(map, rows, first_panel, pixel);
  }
  void advance() {
    at += step_;
    if (++column_ == columns_) {
      column_ = 0;
      at += gap_;
    }
  }

  Float* at = nullptr;                 // the pixel's lower 8 channels of the first panel
  std::ptrdiff_t half = 0, panel = 0;  // distances of the upper 8 channels and of the next panel

 private:
  std::ptrdiff_t step_ = 0, gap_ = 0;
  std::int32_t column_ = 0, columns_ = 0;
};

}  // namespace
}  // namespace mien::kernels
