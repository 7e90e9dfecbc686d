// Warps the caller's image into the inputs of networks.
#include "tracker/image/sampler.h"

#include <algorithm>
#include <cmath>

namespace mien::tracker {
namespace {

constexpr float kScale = 1.0f / 127.5f;
constexpr float kBlack = -1.0f;
// With a larger distance between samples, bilinear sampling would skip too many pixels.
constexpr float kMaxSampleDistance = 1.5f;
constexpr std::int32_t kMaxBox = 8;

kernels::PixelFormat pixel_format(std::int32_t format) {
  switch (format) {
    case MIEN_IMAGE_GRAY8:
      return kernels::PixelFormat::kGray8;
    case MIEN_IMAGE_RGB:
      return kernels::PixelFormat::kRgb;
    case MIEN_IMAGE_BGR:
      return kernels::PixelFormat::kBgr;
    case MIEN_IMAGE_RGBA:
      return kernels::PixelFormat::kRgba;
    case MIEN_IMAGE_BGRA:
      return kernels::PixelFormat::kBgra;
    default:
      return kernels::PixelFormat::kYuv420;
  }
}

std::ptrdiff_t pixel_bytes(std::int32_t format) {
  switch (format) {
    case MIEN_IMAGE_RGB:
    case MIEN_IMAGE_BGR:
      return 3;
    case MIEN_IMAGE_RGBA:
    case MIEN_IMAGE_BGRA:
      return 4;
    default:
      return 1;
  }
}

kernels::Plane plane(const mien_image& image, int index, int first_byte, std::ptrdiff_t pixel) {
  return {static_cast<const std::uint8_t*>(image.planes[index]) + first_byte,
          image.row_stride_bytes[index], pixel};
}

void set_planes(const mien_image& image, kernels::WarpArgs& args) {
  args.plane[0] = plane(image, 0, 0, pixel_bytes(image.format));
  if (image.format == MIEN_IMAGE_I420) {
    args.plane[1] = plane(image, 1, 0, image.chroma_pixel_stride_bytes);
    args.plane[2] = plane(image, 2, 0, image.chroma_pixel_stride_bytes);
  } else if (image.format == MIEN_IMAGE_NV12 || image.format == MIEN_IMAGE_NV21) {
    const int u = image.format == MIEN_IMAGE_NV12 ? 0 : 1;
    args.plane[1] = plane(image, 1, u, 2);
    args.plane[2] = plane(image, 1, 1 - u, 2);
  }
}

// The smallest box (a power of two, in pixels) whose means are dense enough to be sampled at this
// distance, in pixels.
std::int32_t box(float sample_distance) {
  std::int32_t box = 1;
  while (box < kMaxBox && sample_distance > kMaxSampleDistance * static_cast<float>(box)) {
    box *= 2;
  }
  return box;
}

}  // namespace

void Sampler::warp(const ImageView& view, const Crop& crop, const Raster& raster,
                   std::span<float> out) const {
  const auto rows = static_cast<float>(raster.rows);
  const auto columns = static_cast<float>(raster.columns);
  const float unit = raster.extent / rows;
  const Affine sample_to_crop = {unit, 0,    0.5f * (1.0f - unit * columns),
                                 0,    unit, 0.5f * (1.0f - unit * rows)};
  const Affine m = compose(view.to_buffer, compose(crop_to_image(crop), sample_to_crop));
  kernels::WarpArgs args = {};
  args.format = pixel_format(view.image.format);
  set_planes(view.image, args);
  args.full_range = view.image.full_range != 0;
  args.yuv_matrix = view.image.yuv_matrix == MIEN_YUV_BT709 ? kernels::kBt709 : kernels::kBt601;
  args.image_width = view.image.width;
  args.image_height = view.image.height;
  const float matrix[6] = {m.xx, m.xy, m.x0, m.yx, m.yy, m.y0};
  std::copy(std::begin(matrix), std::end(matrix), args.matrix);
  const float sample_distance = crop.side * unit * view.buffer_pixels_per_pixel;
  args.box = box(sample_distance);
  args.chroma_box = box(0.5f * sample_distance);
  args.y = out.data();
  args.width = raster.columns;
  args.height = raster.rows;
  args.scale = kScale;
  args.offset = kBlack;
  args.samples = samples_;
  warp_(args);
}

void Sampler::warp_with_black_border(const ImageView& view, const Crop& crop, std::int32_t samples,
                                     std::span<float> out) const {
  warp(view, crop, {samples, samples, 1.0f}, out);
  const float c = std::cos(crop.roll), s = std::sin(crop.roll);
  const float pixels_per_sample = crop.side / static_cast<float>(samples);
  const auto offset = [&](std::int32_t index) {
    return (static_cast<float>(index) + 0.5f) * pixels_per_sample - crop.side / 2;
  };
  const Rect& region = view.region;
  float* pixel = out.data();
  for (std::int32_t i = 0; i < samples; ++i) {
    for (std::int32_t j = 0; j < samples; ++j, pixel += 3) {
      const float x = crop.center.x + c * offset(j) - s * offset(i) - region.corner.x;
      const float y = crop.center.y + s * offset(j) + c * offset(i) - region.corner.y;
      if (!(x >= 0.0f && x <= region.width && y >= 0.0f && y <= region.height)) {
        std::fill(pixel, pixel + 3, kBlack);
      }
    }
  }
}

}  // namespace mien::tracker
