// Copies images plane by plane, without the gaps between rows.
#include "apps/mien/tracking/held_image.h"

#include <algorithm>
#include <array>

namespace mien::app {
namespace {

struct Plane {
  int rows = 0;
  int row_bytes = 0;
};

std::array<Plane, 3> planes_of(const mien_image& image) {
  switch (image.format) {
    case MIEN_IMAGE_RGB:
      return {{{image.height, image.width * 3}}};
    case MIEN_IMAGE_I420: {
      const int apart = std::max(image.chroma_pixel_stride_bytes, 1);
      const Plane chroma = {(image.height + 1) / 2, ((image.width + 1) / 2 - 1) * apart + 1};
      return {{{image.height, image.width}, chroma, chroma}};
    }
    default:
      return {{{image.height, image.width}}};
  }
}

}  // namespace

HeldImage::HeldImage(const mien_image& image) : image_(image) {
  const std::array<Plane, 3> planes = planes_of(image);
  std::size_t bytes = 0;
  for (const Plane& plane : planes) {
    bytes += static_cast<std::size_t>(plane.rows) * static_cast<std::size_t>(plane.row_bytes);
  }
  pixels_.resize(bytes);
  std::byte* to = pixels_.data();
  for (std::size_t i = 0; i < planes.size() && planes[i].rows > 0; ++i) {
    const auto* from = static_cast<const std::byte*>(image.planes[i]);
    image_.planes[i] = to;
    image_.row_stride_bytes[i] = planes[i].row_bytes;
    for (int row = 0; row < planes[i].rows; ++row) {
      to = std::copy_n(from + std::ptrdiff_t{row} * image.row_stride_bytes[i], planes[i].row_bytes,
                       to);
    }
  }
}

}  // namespace mien::app
