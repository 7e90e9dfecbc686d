// Validates the caller's image and computes the map from the scene to its pixels.
#include "tracker/image/image_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>

#include "tracker/api/versioned_struct.h"

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

bool is_yuv420(std::int32_t format) {
  return format == MIEN_IMAGE_NV12 || format == MIEN_IMAGE_NV21 || format == MIEN_IMAGE_I420;
}

// Whether `pixels` pixels from `first` on lie within `length` pixels.
bool is_inside(std::int32_t first, std::int32_t pixels, std::int32_t length) {
  return first >= 0 && pixels >= 1 && first <= length - pixels;
}

mien_status check_region(const mien_image& image) {
  const std::int32_t* const region = image.region;
  const bool odd = is_yuv420(image.format) && (region[0] % 2 != 0 || region[1] % 2 != 0);
  return !odd && is_inside(region[0], region[2], image.width) &&
                 is_inside(region[1], region[3], image.height)
             ? MIEN_OK
             : MIEN_ERROR_IMAGE_REGION;
}

bool has_region(const mien_image& image) {
  return std::any_of(std::begin(image.region), std::end(image.region),
                     [](std::int32_t number) { return number != 0; });
}

// The first byte of a plane, moved by `bytes` within a row and by `rows`.
const void* plane_at(const mien_image& image, std::size_t plane, std::int64_t bytes,
                     std::int64_t rows) {
  return static_cast<const std::byte*>(image.planes[plane]) +
         (rows * image.row_stride_bytes[plane] + bytes);
}

// The image cropped to its region.
mien_image cropped(const mien_image& image) {
  mien_image part = image;
  const std::int64_t x = image.region[0];
  const std::int64_t y = image.region[1];
  part.width = image.region[2];
  part.height = image.region[3];
  const auto planes = planes_of(image);
  part.planes[0] = plane_at(image, 0, x * (planes[0].row_bytes / image.width), y);
  const bool planar = image.format == MIEN_IMAGE_I420;
  const std::int64_t step = planar ? image.chroma_pixel_stride_bytes : 2;
  for (std::size_t i = 1; i < planes.size() && planes[i].rows > 0; ++i) {
    part.planes[i] = plane_at(image, i, x / 2 * step, y / 2);
  }
  return part;
}

bool is_side(std::int32_t pixels) { return pixels >= 1 && pixels <= MIEN_MAX_IMAGE_SIDE; }

bool is_aspect(float value) { return value >= 0.1f && value <= 10.0f; }

bool is_length(float value) { return std::isfinite(value) && value >= 0.0f; }

mien_status check_values(const mien_image& image) {
  if (!is_side(image.width) || !is_side(image.height) || !is_aspect(image.pixel_aspect)) {
    return MIEN_ERROR_IMAGE_SIZE;
  }
  const std::int32_t r = image.rotation;
  if (r != 0 && r != 90 && r != 180 && r != 270) {
    return MIEN_ERROR_IMAGE_ROTATION;
  }
  if (image.yuv_matrix != MIEN_YUV_BT601 && image.yuv_matrix != MIEN_YUV_BT709) {
    return MIEN_ERROR_IMAGE_FORMAT;
  }
  if (!is_length(image.focal_length_px) || !is_length(image.principal_x) ||
      !is_length(image.principal_y)) {
    return MIEN_ERROR_IMAGE_CAMERA;
  }
  return MIEN_OK;
}

// Maps the upright image to the buffer.
Affine upright_to_buffer(const mien_image& image) {
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

// The region of the buffer in scene coordinates. `to_buffer` rotates and flips after it stretches x
// by 1 / aspect, so its transpose inverts everything but the stretch.
Rect region_in_scene(const Affine& to_buffer, float aspect, const std::int32_t* region) {
  const auto to_scene = [&](std::int32_t x, std::int32_t y) {
    const float dx = static_cast<float>(x) - to_buffer.x0;
    const float dy = static_cast<float>(y) - to_buffer.y0;
    return Point{(to_buffer.xx * dx + to_buffer.yx * dy) * (aspect * aspect),
                 to_buffer.xy * dx + to_buffer.yy * dy};
  };
  const Point a = to_scene(region[0], region[1]);
  const Point b = to_scene(region[0] + region[2], region[1] + region[3]);
  return {{std::min(a.x, b.x), std::min(a.y, b.y)}, std::abs(a.x - b.x), std::abs(a.y - b.y)};
}

Camera camera_of(const mien_image& image, const ImageView& view, float horizontal_fov) {
  Camera camera;
  camera.focal_px = image.focal_length_px > 0.0f ? image.focal_length_px
                                                 : view.width / 2 / std::tan(horizontal_fov / 2);
  const bool has_principal = image.principal_x > 0.0f || image.principal_y > 0.0f;
  const Point principal = has_principal ? Point{image.principal_x, image.principal_y}
                                        : Point{view.width / 2, view.height / 2};
  camera.principal = to_upright(view, principal);
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
  if (image.pixel_aspect == 0.0f) {
    image.pixel_aspect = 1.0f;
  }
  if (const mien_status status = check_values(image); status != MIEN_OK) {
    return status;
  }
  if (const mien_status status = check_memory(image); status != MIEN_OK) {
    return status;
  }
  if (!has_region(image)) {
    image.region[2] = image.width;
    image.region[3] = image.height;
  }
  if (const mien_status status = check_region(image); status != MIEN_OK) {
    return status;
  }
  const bool sideways = image.rotation == 90 || image.rotation == 270;
  view.image = cropped(image);
  const float aspect = sideways ? 1.0f / image.pixel_aspect : image.pixel_aspect;
  view.width = aspect * static_cast<float>(sideways ? image.height : image.width);
  view.height = static_cast<float>(sideways ? image.width : image.height);
  view.rotation = image.rotation;
  view.mirrored = image.mirrored != 0;
  const Affine flip = {-1, 0, view.width, 0, 1, 0};
  const Affine unstretch = {1.0f / aspect, 0, 0, 0, 1, 0};
  const Affine upright = compose(upright_to_buffer(image), unstretch);
  const Affine to_buffer = view.mirrored ? compose(upright, flip) : upright;
  view.buffer_pixels_per_pixel = std::max(1.0f, 1.0f / aspect);
  view.region = region_in_scene(to_buffer, aspect, image.region);
  const Affine to_part = {1, 0, -static_cast<float>(image.region[0]),
                          0, 1, -static_cast<float>(image.region[1])};
  view.to_buffer = compose(to_part, to_buffer);
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
