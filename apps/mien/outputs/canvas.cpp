// Draws points, lines, text and images.
#include "apps/mien/outputs/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_easy_font.h>
#pragma GCC diagnostic pop

namespace mien::app {
namespace {

unsigned char clamped(float value) {
  return static_cast<unsigned char>(std::clamp(value + 0.5f, 0.0f, 255.0f));
}

const unsigned char* row(const mien_image& image, int plane, int y) {
  return static_cast<const unsigned char*>(image.planes[plane]) +
         static_cast<std::ptrdiff_t>(image.row_stride_bytes[plane]) * y;
}

// ITU-R BT.601, limited or full range.
Color from_yuv(const mien_image& image, int x, int y) {
  const float luma = row(image, 0, y)[x];
  const int chroma_x = x / 2 * std::max(image.chroma_pixel_stride_bytes, 1);
  const int chroma_y = y / 2;
  const float u = static_cast<float>(row(image, 1, chroma_y)[chroma_x]) - 128.0f;
  const float v = static_cast<float>(row(image, 2, chroma_y)[chroma_x]) - 128.0f;
  const float gain = image.full_range != 0 ? 1.0f : 255.0f / 219.0f;
  const float chroma = image.full_range != 0 ? 1.0f : 255.0f / 224.0f;
  const float base = image.full_range != 0 ? luma : (luma - 16.0f) * gain;
  return {clamped(base + 1.402f * chroma * v),
          clamped(base - chroma * (0.344136f * u + 0.714136f * v)),
          clamped(base + 1.772f * chroma * u)};
}

Color pixel(const mien_image& image, int x, int y) {
  if (image.format == MIEN_IMAGE_I420) {
    return from_yuv(image, x, y);
  }
  if (image.format == MIEN_IMAGE_GRAY8) {
    const unsigned char luma = row(image, 0, y)[x];
    return {luma, luma, luma};
  }
  const unsigned char* rgb = row(image, 0, y) + static_cast<std::ptrdiff_t>(x) * 3;
  return {rgb[0], rgb[1], rgb[2]};
}

// For each of `places` output pixels, the index of the input pixel it shows.
std::vector<int> spread(int pixels, int places, bool backwards) {
  std::vector<int> sources(static_cast<std::size_t>(places));
  for (int i = 0; i < places; ++i) {
    const int pixel = static_cast<int>(std::int64_t{i} * pixels / places);
    sources[static_cast<std::size_t>(i)] = backwards ? pixels - 1 - pixel : pixel;
  }
  return sources;
}

}  // namespace

Canvas::Canvas(int width, int height)
    : width_(width),
      height_(height),
      rgb_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3) {}

void Canvas::set(int x, int y, Color color) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) {
    return;
  }
  unsigned char* at =
      rgb_.data() + (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(x)) *
                        3;
  at[0] = color.r;
  at[1] = color.g;
  at[2] = color.b;
}

void Canvas::paste(const mien_image& image, int width, int height) {
  const bool sideways = image.rotation % 180 != 0;
  const bool from_right = image.rotation == 180 || image.rotation == 270;
  const bool from_below = image.rotation == 90 || image.rotation == 180;
  const std::vector<int> columns = spread(image.width, sideways ? height : width, from_right);
  const std::vector<int> rows = spread(image.height, sideways ? width : height, from_below);
  for (int y = 0; y < std::min(height, height_); ++y) {
    for (int x = 0; x < std::min(width, width_); ++x) {
      const auto column = static_cast<std::size_t>(sideways ? y : x);
      const auto line = static_cast<std::size_t>(sideways ? x : y);
      set(x, y, pixel(image, columns[column], rows[line]));
    }
  }
}

void Canvas::fill(int x, int y, int width, int height, Color color) {
  for (int j = y; j < y + height; ++j) {
    for (int i = x; i < x + width; ++i) {
      set(i, j, color);
    }
  }
}

void Canvas::dot(float x, float y, float radius, Color color) {
  const int reach = static_cast<int>(std::ceil(radius));
  const int cx = static_cast<int>(std::lround(x));
  const int cy = static_cast<int>(std::lround(y));
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      if (static_cast<float>(i * i + j * j) <= radius * radius) {
        set(cx + i, cy + j, color);
      }
    }
  }
}

void Canvas::line(float x0, float y0, float x1, float y1, Color color) {
  const float length = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
  const int steps = std::clamp(static_cast<int>(std::ceil(length)), 1, 4 * (width_ + height_));
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    set(static_cast<int>(std::lround(x0 + t * (x1 - x0))),
        static_cast<int>(std::lround(y0 + t * (y1 - y0))), color);
  }
}

void Canvas::text(int x, int y, const std::string& text, Color color) {
  struct Vertex {
    float x, y, z;
    unsigned char rgba[4];
  };
  std::string mutable_text = text;  // the font's interface is not const
  std::vector<std::array<Vertex, 4>> quads(text.size() * 24 + 8);
  const int count =
      stb_easy_font_print(static_cast<float>(x), static_cast<float>(y), mutable_text.data(),
                          nullptr, quads.data(), static_cast<int>(quads.size() * sizeof quads[0]));
  for (int i = 0; i < count; ++i) {
    const auto& quad = quads[static_cast<std::size_t>(i)];
    fill(static_cast<int>(quad[0].x), static_cast<int>(quad[0].y),
         static_cast<int>(quad[2].x - quad[0].x), static_cast<int>(quad[2].y - quad[0].y), color);
  }
}

}  // namespace mien::app
