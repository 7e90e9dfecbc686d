// Draws test images and converts them to the layouts of cameras.
#include "tests/tracker/picture.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace mien::tests {
namespace {

// Avoids calls per pixel, because drawing dominates the time of the tracker's tests.
std::uint8_t byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 255.0f) + 0.5f);
}

// The scene in the orientation of the buffer: mirrored, then rotated back from upright.
struct Oriented {
  const Picture& scene;
  const Layout& layout;

  [[nodiscard]] bool sideways() const { return layout.rotation % 180 != 0; }
  [[nodiscard]] int width() const { return sideways() ? scene.height() : scene.width(); }
  [[nodiscard]] int height() const { return sideways() ? scene.width() : scene.height(); }
  [[nodiscard]] const std::uint8_t* pixel(int x, int y) const {
    int upright_x = x;
    int upright_y = y;
    if (layout.rotation == 90) {
      upright_x = scene.width() - 1 - y;
      upright_y = x;
    } else if (layout.rotation == 180) {
      upright_x = scene.width() - 1 - x;
      upright_y = scene.height() - 1 - y;
    } else if (layout.rotation == 270) {
      upright_x = y;
      upright_y = scene.height() - 1 - x;
    }
    return scene.pixel(layout.mirrored ? scene.width() - 1 - upright_x : upright_x, upright_y);
  }
};

// Weights of red and blue in luma.
struct LumaWeights {
  float red, blue;
};
LumaWeights luma_weights(mien_yuv_matrix matrix) {
  return matrix == MIEN_YUV_BT709 ? LumaWeights{0.2126f, 0.0722f} : LumaWeights{0.299f, 0.114f};
}

float luma(const std::uint8_t* rgb, bool full_range, mien_yuv_matrix matrix = MIEN_YUV_BT601) {
  const LumaWeights s = luma_weights(matrix);
  const float y = s.red * rgb[0] + (1.0f - s.red - s.blue) * rgb[1] + s.blue * rgb[2];
  return full_range ? y : 16.0f + y * 219.0f / 255.0f;
}

struct Chroma {
  std::uint8_t u, v;
};

Chroma chroma(const Oriented& picture, int cx, int cy, const Layout& layout) {
  const LumaWeights s = luma_weights(layout.yuv_matrix);
  float u = 0.0f;
  float v = 0.0f;
  for (int k = 0; k < 4; ++k) {
    const std::uint8_t* rgb = picture.pixel(std::min(2 * cx + k % 2, picture.width() - 1),
                                            std::min(2 * cy + k / 2, picture.height() - 1));
    const float y = luma(rgb, true, layout.yuv_matrix);
    u += (rgb[2] - y) / (2.0f - 2.0f * s.blue) / 4.0f;
    v += (rgb[0] - y) / (2.0f - 2.0f * s.red) / 4.0f;
  }
  const float gain = layout.full_range ? 1.0f : 224.0f / 255.0f;
  return {byte(128.0f + gain * u), byte(128.0f + gain * v)};
}

int bytes_per_pixel(mien_image_format format) {
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

void write_pixel(const Layout& layout, const std::uint8_t* rgb, std::uint8_t* out) {
  switch (layout.format) {
    case MIEN_IMAGE_RGB:
    case MIEN_IMAGE_RGBA:
      std::copy(rgb, rgb + 3, out);
      break;
    case MIEN_IMAGE_BGR:
    case MIEN_IMAGE_BGRA:
      std::reverse_copy(rgb, rgb + 3, out);
      break;
    default:
      *out = byte(luma(rgb, layout.full_range, layout.yuv_matrix));
  }
}

}  // namespace

Picture::Picture(int width, int height)
    : width_(width),
      height_(height),
      rgb_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
  struct Column {
    float u, sin, cos;
  };
  std::vector<Column> columns;
  for (int x = 0; x < width; ++x) {
    const float u = static_cast<float>(x) / static_cast<float>(width);
    columns.push_back({u, std::sin(7.0f * u), std::cos(7.0f * u)});
  }
  for (int y = 0; y < height; ++y) {
    const float v = static_cast<float>(y) / static_cast<float>(height);
    const std::uint8_t green = byte(14.0f + 8.0f * std::sin(9.0f * v));
    const float sin = std::sin(7.0f * v), cos = std::cos(7.0f * v);
    std::uint8_t* rgb = at(0, y);
    for (const Column& column : columns) {
      rgb[0] = byte(30.0f + 20.0f * column.u);
      rgb[1] = green;
      rgb[2] = byte(16.0f + 9.0f * (column.cos * cos - column.sin * sin));  // of 7 (u + v)
      rgb += 3;
    }
  }
}

void Picture::disc(float center_x, float center_y, float diameter) {
  const float reach = diameter / 2 + 0.5f;  // of the anti-aliased edge
  const auto first = [reach](float center) {
    return static_cast<int>(std::max(0.0f, std::floor(center - reach)));
  };
  const auto end = [reach](float center, int size) {
    return static_cast<int>(std::clamp(std::ceil(center + reach), 0.0f, static_cast<float>(size)));
  };
  for (int y = first(center_y); y < end(center_y, height_); ++y) {
    for (int x = first(center_x); x < end(center_x, width_); ++x) {
      const float dx = static_cast<float>(x) + 0.5f - center_x;
      const float dy = static_cast<float>(y) + 0.5f - center_y;
      const float cover = std::clamp(reach - std::sqrt(dx * dx + dy * dy), 0.0f, 1.0f);
      // The colour varies: warmer on the left, darker at the top.
      const float colour[3] = {240.0f - 15.0f * dx / diameter, 230.0f + 20.0f * dy / diameter,
                               180.0f + 45.0f * dx / diameter};
      for (int c = 0; c < 3; ++c) {
        at(x, y)[c] = byte(static_cast<float>(at(x, y)[c]) * (1.0f - cover) + colour[c] * cover);
      }
    }
  }
}

void Picture::grey() {
  for (std::size_t i = 0; i < rgb_.size(); i += 3) {
    std::fill_n(&rgb_[i], 3, byte(luma(&rgb_[i], true)));
  }
}

void Picture::noise(unsigned seed) {
  std::mt19937 random(seed);
  std::generate(rgb_.begin(), rgb_.end(), [&] { return static_cast<std::uint8_t>(random()); });
}

Picture Picture::part(int x, int y, int width, int height) const {
  Picture part(width, height);
  for (int row = 0; row < height; ++row) {
    std::copy_n(pixel(x, y + row), 3 * width, part.at(0, row));
  }
  return part;
}

Buffer::Buffer(const Picture& scene, const Layout& layout) {
  const Oriented picture = {scene, layout};
  mien_image_default(&image_);
  image_.format = layout.format;
  image_.width = picture.width();
  image_.height = picture.height();
  image_.rotation = layout.rotation;
  image_.mirrored = layout.mirrored;
  image_.full_range = layout.full_range;
  image_.yuv_matrix = layout.yuv_matrix;
  const int pixel_bytes = bytes_per_pixel(layout.format);
  add_plane(0, image_.width * pixel_bytes, image_.height, layout);
  const bool unchanged =
      layout.format == MIEN_IMAGE_RGB && layout.rotation == 0 && !layout.mirrored;
  for (int y = 0; y < image_.height; ++y) {
    if (unchanged) {
      std::copy_n(scene.pixel(0, y), 3 * image_.width, at(0, 0, y));
      continue;
    }
    for (int x = 0; x < image_.width; ++x) {
      write_pixel(layout, picture.pixel(x, y), at(0, x * pixel_bytes, y));
    }
  }
  const bool semi_planar = layout.format == MIEN_IMAGE_NV12 || layout.format == MIEN_IMAGE_NV21;
  if (!semi_planar && layout.format != MIEN_IMAGE_I420) {
    return;
  }
  const int step = semi_planar ? 2 : layout.chroma_pixel_stride;
  image_.chroma_pixel_stride_bytes = semi_planar ? 0 : step;
  const int chroma_width = (image_.width + 1) / 2;
  const int chroma_height = (image_.height + 1) / 2;
  const int row_bytes = semi_planar ? 2 * chroma_width : (chroma_width - 1) * step + 1;
  add_plane(1, row_bytes, chroma_height, layout);
  if (!semi_planar) {
    add_plane(2, row_bytes, chroma_height, layout);
  }
  const int u_byte = layout.format == MIEN_IMAGE_NV21 ? 1 : 0;
  for (int y = 0; y < chroma_height; ++y) {
    for (int x = 0; x < chroma_width; ++x) {
      const Chroma c = chroma(picture, x, y, layout);
      *at(1, x * step + (semi_planar ? u_byte : 0), y) = c.u;
      *at(semi_planar ? 1 : 2, x * step + (semi_planar ? 1 - u_byte : 0), y) = c.v;
    }
  }
}

// Allocates no byte after the last row, which has no padding, so that sanitizers find reads beyond
// it.
void Buffer::add_plane(int plane, int row_bytes, int rows, const Layout& layout) {
  const int stride = row_bytes + layout.row_padding_bytes;
  planes_[plane].assign(static_cast<std::size_t>(stride * (rows - 1) + row_bytes), 0xAA);
  const int first = layout.bottom_up ? stride * (rows - 1) : 0;
  image_.planes[plane] = planes_[plane].data() + first;
  image_.row_stride_bytes[plane] = layout.bottom_up ? -stride : stride;
}

std::uint8_t* Buffer::at(int plane, int x_bytes, int y) {
  return const_cast<std::uint8_t*>(static_cast<const std::uint8_t*>(image_.planes[plane])) +
         static_cast<std::ptrdiff_t>(image_.row_stride_bytes[plane]) * y + x_bytes;
}

}  // namespace mien::tests
