// Shrinks images and writes them as BMP.
#include "apps/mien/live_page/preview.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "apps/protocols/bytes.h"

namespace mien::app {
namespace {

using protocols::append_little;

constexpr std::uint32_t kHeaderBytes = 54;

struct Color {
  double red = 0.0, green = 0.0, blue = 0.0;
};

double sample(const mien_image& image, int plane, int x, int y, int pixel_stride) {
  const auto* bytes = static_cast<const unsigned char*>(image.planes[plane]);
  return bytes[std::ptrdiff_t{y} * image.row_stride_bytes[plane] +
               std::ptrdiff_t{x} * pixel_stride];
}

// Luma 0..255.
double luma(const mien_image& image, int x, int y) {
  const double value = sample(image, 0, x, y, 1);
  return image.full_range != 0 ? value : (value - 16.0) * 255.0 / 219.0;
}

// BT.601, which is close enough to BT.709 for a preview.
Color color_of_yuv(const mien_image& image, int x, int y) {
  const int stride = std::max(1, image.chroma_pixel_stride_bytes);
  const double range = image.full_range != 0 ? 1.0 : 255.0 / 224.0;
  const double blue = (sample(image, 1, x / 2, y / 2, stride) - 128.0) * range;
  const double red = (sample(image, 2, x / 2, y / 2, stride) - 128.0) * range;
  const double light = luma(image, x, y);
  return {light + 1.402 * red, light - 0.344 * blue - 0.714 * red, light + 1.772 * blue};
}

Color color_of(const mien_image& image, int x, int y) {
  if (image.format == MIEN_IMAGE_I420) {
    return color_of_yuv(image, x, y);
  }
  if (image.format == MIEN_IMAGE_RGB) {
    const auto* pixel = static_cast<const unsigned char*>(image.planes[0]) +
                        std::ptrdiff_t{y} * image.row_stride_bytes[0] + std::ptrdiff_t{x} * 3;
    return {1.0 * pixel[0], 1.0 * pixel[1], 1.0 * pixel[2]};
  }
  const double light = luma(image, x, y);
  return {light, light, light};
}

char byte_of(double value) {
  return static_cast<char>(static_cast<unsigned char>(std::lround(std::clamp(value, 0.0, 255.0))));
}

std::string header(std::uint32_t width, std::uint32_t height, std::uint32_t pixel_bytes) {
  std::string bmp = "BM";
  for (const std::uint32_t value :
       {kHeaderBytes + pixel_bytes, 0U, kHeaderBytes, 40U, width, height}) {
    append_little(bmp, value);
  }
  append_little(bmp, std::uint16_t{1});   // planes
  append_little(bmp, std::uint16_t{24});  // bits per pixel
  bmp.resize(kHeaderBytes, '\0');         // no compression, no palette
  return bmp;
}

// Scales a coordinate of the preview, in quarters of a pixel, to the image: from a side of `small`
// pixels to one of `source` pixels.
int source_position(int quarter, int small, int source) {
  return std::min(source - 1,
                  static_cast<int>(std::int64_t{quarter} * source / (std::int64_t{small} * 4)));
}

// The mean of four points in the area of the image that a pixel of the preview covers.
Color mean_color(const mien_image& image, int x, int y, int width, int height) {
  Color sum;
  for (const int down : {1, 3}) {
    for (const int right : {1, 3}) {
      const Color color = color_of(image, source_position(4 * x + right, width, image.width),
                                   source_position(4 * y + down, height, image.height));
      sum = {sum.red + color.red, sum.green + color.green, sum.blue + color.blue};
    }
  }
  return {sum.red / 4.0, sum.green / 4.0, sum.blue / 4.0};
}

}  // namespace

std::string preview_of(const mien_image& image) {
  const double aspect = image.pixel_aspect > 0.0f ? static_cast<double>(image.pixel_aspect) : 1.0;
  const double wide = image.width * aspect;
  const double scale = std::min(1.0, kPreviewSide / std::max(wide, 1.0 * image.height));
  const int width = std::max(1, static_cast<int>(std::lround(wide * scale)));
  const int height = std::max(1, static_cast<int>(std::lround(image.height * scale)));
  const std::size_t row_bytes = (static_cast<std::size_t>(width) * 3 + 3) / 4 * 4;
  const std::size_t pixel_bytes = row_bytes * static_cast<std::size_t>(height);
  std::string bmp = header(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                           static_cast<std::uint32_t>(pixel_bytes));
  bmp.reserve(kHeaderBytes + pixel_bytes);
  for (int y = height - 1; y >= 0; --y) {  // from the bottom
    for (int x = 0; x < width; ++x) {
      const Color color = mean_color(image, x, y, width, height);
      bmp += byte_of(color.blue);
      bmp += byte_of(color.green);
      bmp += byte_of(color.red);
    }
    bmp.resize((bmp.size() - kHeaderBytes + row_bytes - 1) / row_bytes * row_bytes + kHeaderBytes,
               '\0');
  }
  return bmp;
}

}  // namespace mien::app
