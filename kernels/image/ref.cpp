#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

struct Rgb {
  double r = 0, g = 0, b = 0;
};

Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
Rgb operator*(double s, Rgb a) { return {s * a.r, s * a.g, s * a.b}; }

// Everything outside repeats the border, so coordinates beyond it by more than a pixel are all the
// same.
double kept_near(double coordinate, std::int32_t size) {
  return std::isfinite(coordinate) ? std::clamp(coordinate, -1.0, size + 1.0) : 0.0;
}

double byte_at(const Plane& plane, std::int32_t x, std::int32_t y, std::int32_t width,
               std::int32_t height) {
  x = std::clamp(x, 0, width - 1);
  y = std::clamp(y, 0, height - 1);
  return plane.data[y * plane.row_bytes + x * plane.pixel_bytes];
}

// Bilinear sample at (x, y), sample centres at halves.
double bilinear(const Plane& plane, double x, double y, std::int32_t width, std::int32_t height) {
  x = kept_near(x, width) - 0.5;
  y = kept_near(y, height) - 0.5;
  const std::int32_t x0 = static_cast<std::int32_t>(std::floor(x));
  const std::int32_t y0 = static_cast<std::int32_t>(std::floor(y));
  const double a = x - x0, b = y - y0;
  const auto at = [&](std::int32_t dx, std::int32_t dy) {
    return byte_at(plane, x0 + dx, y0 + dy, width, height);
  };
  return (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
}

double full_luma(double luma, bool full_range) {
  return full_range ? luma : (luma - 16.0) * (255.0 / 219.0);
}

Rgb clamped(Rgb c) {
  return {std::clamp(c.r, 0.0, 255.0), std::clamp(c.g, 0.0, 255.0), std::clamp(c.b, 0.0, 255.0)};
}

Rgb yuv_sample(const WarpArgs& a, double x, double y) {
  const std::int32_t chroma_w = (a.image_width + 1) / 2, chroma_h = (a.image_height + 1) / 2;
  const double gain = a.full_range ? 1.0 : 255.0 / 224.0;
  const double luma =
      full_luma(bilinear(a.plane[0], x, y, a.image_width, a.image_height), a.full_range);
  const double u = (bilinear(a.plane[1], x / 2, y / 2, chroma_w, chroma_h) - 128) * gain;
  const double v = (bilinear(a.plane[2], x / 2, y / 2, chroma_w, chroma_h) - 128) * gain;
  return clamped({luma + 1.402 * v, luma - 0.344136 * u - 0.714136 * v, luma + 1.772 * u});
}

Rgb packed_sample(const WarpArgs& a, double x, double y) {
  const bool reversed = a.format == PixelFormat::kBgr || a.format == PixelFormat::kBgra;
  double channel[3];
  for (std::int32_t c = 0; c < 3; ++c) {
    Plane one = a.plane[0];
    one.data += c;
    channel[c] = bilinear(one, x, y, a.image_width, a.image_height);
  }
  return reversed ? Rgb{channel[2], channel[1], channel[0]}
                  : Rgb{channel[0], channel[1], channel[2]};
}

Rgb sample(const WarpArgs& a, double x, double y) {
  if (a.format == PixelFormat::kYuv420) {
    return yuv_sample(a, x, y);
  }
  if (a.format == PixelFormat::kGray8) {
    const double luma =
        full_luma(bilinear(a.plane[0], x, y, a.image_width, a.image_height), a.full_range);
    return clamped({luma, luma, luma});
  }
  return packed_sample(a, x, y);
}

}  // namespace

void warp(const WarpArgs& a) {
  for (std::int32_t i = 0; i < a.height; ++i) {
    for (std::int32_t j = 0; j < a.width; ++j) {
      Rgb sum;
      for (std::int32_t v = 0; v < a.taps; ++v) {
        for (std::int32_t u = 0; u < a.taps; ++u) {
          const double x = j + (u + 0.5) / a.taps, y = i + (v + 0.5) / a.taps;
          sum =
              sum + sample(a, static_cast<double>(a.matrix[0]) * x + a.matrix[1] * y + a.matrix[2],
                           static_cast<double>(a.matrix[3]) * x + a.matrix[4] * y + a.matrix[5]);
        }
      }
      const Rgb mean = (1.0 / (a.taps * a.taps)) * sum;
      float* out = a.y + (std::ptrdiff_t{i} * a.width + j) * 3;
      out[0] = static_cast<float>(mean.r * a.scale + a.offset);
      out[1] = static_cast<float>(mean.g * a.scale + a.offset);
      out[2] = static_cast<float>(mean.b * a.scale + a.offset);
    }
  }
}

}  // namespace mien::kernels::ref
