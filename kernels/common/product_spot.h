// Start of a tile of a product, for tiers whose tiles store pixels one by one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/common/product.h"

namespace mien::kernels {
namespace {

// Iterates over pixels in rows.
class Cursor {
 public:
  Cursor(const PixelRows& rows, std::int32_t pixel)
      : pixel_(pixel * rows.pixel_elems), column_(pixel), rows_(&rows) {
    if (pixel >= rows.row_pixels) {
      pixel_ += pixel / rows.row_pixels * rows.row_gap_elems;
      column_ = pixel % rows.row_pixels;
    }
  }
  [[nodiscard]] std::ptrdiff_t at(std::int32_t panel) const {
    return pixel_ + panel * rows_->panel_elems;
  }
  void advance() {
    pixel_ += rows_->pixel_elems;
    if (++column_ == rows_->row_pixels) {
      column_ = 0;
      pixel_ += rows_->row_gap_elems;
    }
  }

 private:
  std::ptrdiff_t pixel_;
  std::int32_t column_;
  const PixelRows* rows_;
};

// Position of a tile: a panel and a pixel. Each tile advances it past its own pixels.
struct Spot {
  Spot(const ProductArgs& args, std::int32_t first_panel, std::int32_t pixel)
      : a(args),
        panel(first_panel),
        x(args.x + std::ptrdiff_t{pixel} * kChannels),
        y(args.y_rows, pixel),
        residual(args.residual == nullptr ? args.y_rows : args.residual_rows, pixel) {}
  const ProductArgs& a;
  std::int32_t panel;
  const float* x;
  Cursor y, residual;
};

}  // namespace
}  // namespace mien::kernels
