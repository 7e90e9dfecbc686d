#include "tracker/image_view.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "tracker/versioned_struct.h"

namespace mien::tracker {
namespace {

struct Plane {
  std::int64_t rows = 0;  // 0: the format has no such plane
  std::int64_t row_bytes = 0;
};

std::array<Plane, 3> planes_of(const mien_image& image) {
  const std::int64_t width = image.width;
  const std::int64_t height = image.height;
  const std::int64_t chroma_width = (width + 1) / 2;
  const std::int64_t chroma_height = (height + 1) / 2;
  const std::int64_t step = image.chroma_pixel_stride_bytes;
  const Plane chroma = {chroma_height, (chroma_width - 1) * step + 1};
  switch (image.format) {
    case MIEN_IMAGE_GRAY8:
      return {{{height, width}, {}, {}}};
    case MIEN_IMAGE_RGB:
    case MIEN_IMAGE_BGR:
      return {{{height, width * 3}, {}, {}}};
    case MIEN_IMAGE_RGBA:
    case MIEN_IMAGE_BGRA:
      return {{{height, width * 4}, {}, {}}};
    case MIEN_IMAGE_NV12:
    case MIEN_IMAGE_NV21:
      return {{{height, width}, {chroma_height, chroma_width * 2}, {}}};
    case MIEN_IMAGE_I420:
      return {{{height, width}, chroma, chroma}};
    default:
      return {};
  }
}

mien_status check_memory(const mien_image& image) {
  const auto planes = planes_of(image);
  if (planes[0].rows == 0) {
    return MIEN_ERROR_IMAGE_FORMAT;
  }
  if (image.chroma_pixel_stride_bytes < 1) {
    return MIEN_ERROR_IMAGE_STRIDE;
  }
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].rows > 0 && image.planes[i] == nullptr) {
      return MIEN_ERROR_IMAGE_PLANE;
    }
    const std::int64_t stride = image.row_stride_bytes[i];
    if (planes[i].rows > 1 && std::abs(stride) < planes[i].row_bytes) {
      return MIEN_ERROR_IMAGE_STRIDE;
    }
  }
  return MIEN_OK;
}

bool is_side(std::int32_t pixels) { return pixels >= 1 && pixels <= MIEN_MAX_IMAGE_SIDE; }

bool is_length(float value) { return std::isfinite(value) && value >= 0.0f; }

mien_status check_values(const mien_image& image) {
  if (!is_side(image.width) || !is_side(image.height)) {
    return MIEN_ERROR_IMAGE_SIZE;
  }
  const std::int32_t r = image.rotation;
  if (r != 0 && r != 90 && r != 180 && r != 270) {
    return MIEN_ERROR_IMAGE_ROTATION;
  }
  if (!is_length(image.focal_length_px) || !is_length(image.principal_x) ||
      !is_length(image.principal_y)) {
    return MIEN_ERROR_IMAGE_CAMERA;
  }
  return MIEN_OK;
}

// Upright picture -> buffer.
Affine unturned(const mien_image& image) {
  const auto width = static_cast<float>(image.width);
  const auto height = static_cast<float>(image.height);
  switch (image.rotation) {
    case 90:
      return {0, 1, 0, -1, 0, height};
    case 180:
      return {-1, 0, width, 0, -1, height};
    case 270:
      return {0, -1, width, 1, 0, 0};
    default:
      return {};
  }
}

Camera camera_of(const mien_image& image, const ImageView& view, float horizontal_fov) {
  Camera camera;
  camera.focal_px = image.focal_length_px > 0.0f ? image.focal_length_px
                                                 : view.width / 2 / std::tan(horizontal_fov / 2);
  const bool known = image.principal_x > 0.0f || image.principal_y > 0.0f;
  const Point principal =
      known ? Point{image.principal_x, image.principal_y} : Point{view.width / 2, view.height / 2};
  camera.principal = to_picture(view, principal);
  return camera;
}

}  // namespace

mien_status view_image(const mien_image* given, float horizontal_fov, ImageView& view) {
  if (given == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  mien_image image;
  mien_image_default(&image);
  if (!read_struct(*given, MIEN_SIZE_THROUGH(mien_image, row_stride_bytes), image)) {
    return MIEN_ERROR_STRUCT_SIZE;
  }
  if (image.chroma_pixel_stride_bytes == 0) {
    image.chroma_pixel_stride_bytes = 1;
  }
  if (const mien_status status = check_values(image); status != MIEN_OK) {
    return status;
  }
  if (const mien_status status = check_memory(image); status != MIEN_OK) {
    return status;
  }
  const bool on_side = image.rotation == 90 || image.rotation == 270;
  view.image = image;
  view.width = static_cast<float>(on_side ? image.height : image.width);
  view.height = static_cast<float>(on_side ? image.width : image.height);
  view.rotation = image.rotation;
  view.mirrored = image.mirrored != 0;
  const Affine flip = {-1, 0, view.width, 0, 1, 0};
  view.to_buffer = view.mirrored ? compose(unturned(image), flip) : unturned(image);
  view.camera = camera_of(image, view, horizontal_fov);
  return MIEN_OK;
}

}  // namespace mien::tracker

void mien_image_default(mien_image* image) {
  if (image != nullptr) {
    *image = {};
    image->struct_size = sizeof *image;
    image->full_range = 1;
  }
}
