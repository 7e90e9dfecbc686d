// The reference kernel of warp.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

struct Rgb {
  double r = 0, g = 0, b = 0;
};

// A plane, its reduction and how to sample it.
struct Channel {
  Plane plane;
  std::int32_t width, height;  // samples of the plane
  std::int32_t box;
  double samples_per_pixel;  // of the full plane

  [[nodiscard]] double byte_at(std::int32_t x, std::int32_t y) const {
    x = std::clamp(x, 0, width - 1);
    y = std::clamp(y, 0, height - 1);
    return plane.data[y * plane.row_bytes + x * plane.pixel_bytes];
  }

  // Mean of the box in column c and row r.
  [[nodiscard]] double mean(std::int32_t c, std::int32_t r) const {
    double sum = 0.0;
    for (std::int32_t i = 0; i < box; ++i) {
      for (std::int32_t j = 0; j < box; ++j) {
        sum += byte_at(c * box + j, r * box + i);
      }
    }
    return sum / (box * box);
  }

  // Position in boxes. Positions more than two boxes beyond the border are equivalent.
  [[nodiscard]] double place(double coordinate, std::int32_t size) const {
    const double small = coordinate * samples_per_pixel / box;
    return std::clamp(small, -2.0, static_cast<double>(size) / box + 2.0) - 0.5;
  }

  [[nodiscard]] double bilinear(double x, double y) const {
    x = place(x, width);
    y = place(y, height);
    const auto c = static_cast<std::int32_t>(std::floor(x));
    const auto r = static_cast<std::int32_t>(std::floor(y));
    const double a = x - c, b = y - r;
    return (1 - b) * ((1 - a) * mean(c, r) + a * mean(c + 1, r)) +
           b * ((1 - a) * mean(c, r + 1) + a * mean(c + 1, r + 1));
  }
};

// The channel at byte `first` of each pixel of a packed image.
Channel packed(const WarpArgs& a, std::int32_t first) {
  Plane plane = a.plane[0];
  plane.data += first;
  return {plane, a.image_width, a.image_height, a.box, 1.0};
}

Channel chroma(const WarpArgs& a, std::int32_t index) {
  return {a.plane[index], (a.image_width + 1) / 2, (a.image_height + 1) / 2, a.chroma_box, 0.5};
}

double luma_at(const WarpArgs& a, double x, double y) {
  const double luma = packed(a, 0).bilinear(x, y);
  return a.full_range ? luma : (luma - 16.0) * (255.0 / 219.0);
}

Rgb clamped(Rgb c) {
  return {std::clamp(c.r, 0.0, 255.0), std::clamp(c.g, 0.0, 255.0), std::clamp(c.b, 0.0, 255.0)};
}

Rgb yuv_sample(const WarpArgs& a, double x, double y) {
  const double gain = a.full_range ? 1.0 : 255.0 / 224.0;
  const double luma = luma_at(a, x, y);
  const double u = (chroma(a, 1).bilinear(x, y) - 128) * gain;
  const double v = (chroma(a, 2).bilinear(x, y) - 128) * gain;
  const YuvMatrix& m = a.yuv_matrix;
  return clamped(
      {luma + m.red_of_v * v, luma + m.green_of_u * u + m.green_of_v * v, luma + m.blue_of_u * u});
}

Rgb packed_sample(const WarpArgs& a, double x, double y) {
  const bool reversed = a.format == PixelFormat::kBgr || a.format == PixelFormat::kBgra;
  return {packed(a, reversed ? 2 : 0).bilinear(x, y), packed(a, 1).bilinear(x, y),
          packed(a, reversed ? 0 : 2).bilinear(x, y)};
}

Rgb sample(const WarpArgs& a, double x, double y) {
  if (a.format == PixelFormat::kYuv420) {
    return yuv_sample(a, x, y);
  }
  if (a.format == PixelFormat::kGray8) {
    const double luma = luma_at(a, x, y);
    return clamped({luma, luma, luma});
  }
  return packed_sample(a, x, y);
}

double coordinate(const float* m, double j, double i) {
  const double at =
      static_cast<double>(m[0]) * j + static_cast<double>(m[1]) * i + static_cast<double>(m[2]);
  return std::isfinite(at) ? at : 0.0;
}

}  // namespace

void warp(const WarpArgs& a) {
  for (std::int32_t i = 0; i < a.height; ++i) {
    for (std::int32_t j = 0; j < a.width; ++j) {
      const Rgb rgb = sample(a, coordinate(a.matrix, j + 0.5, i + 0.5),
                             coordinate(a.matrix + 3, j + 0.5, i + 0.5));
      float* out = a.y + (std::ptrdiff_t{i} * a.width + j) * 3;
      out[0] = static_cast<float>(rgb.r * a.scale + a.offset);
      out[1] = static_cast<float>(rgb.g * a.scale + a.offset);
      out[2] = static_cast<float>(rgb.b * a.scale + a.offset);
    }
  }
}

}  // namespace mien::kernels::ref
