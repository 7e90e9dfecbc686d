// Bilinear crops of 8-bit windows in fixed point; the border is repeated outwards.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace {

constexpr int kFraction = 8;  // bits of a place between two pixels

struct Place {
  std::size_t near, far;  // offsets of neighbours
  int share;              // of the far one
};

Place place(float at, std::size_t size, std::size_t step) {
  const float last = static_cast<float>(size - 1);
  const int fixed = static_cast<int>(std::min(std::max(at, 0.0f), last) * (1 << kFraction));
  const std::size_t near = static_cast<std::size_t>(fixed >> kFraction);
  return {near * step, std::min(near + 1, size - 1) * step, fixed & ((1 << kFraction) - 1)};
}

int between(int a, int b, int share) { return (a << kFraction) + (b - a) * share; }

}  // namespace

extern "C" {

// windows [images][side][side][3]; crops [images][4], (cx, cy, side, roll) in pixels of the
// windows; out fp32 [images][3][height][width] in 0..1, `pixels_per_crop` of them to a crop's side.
void sample_crops_u8(const std::uint8_t* windows, std::size_t images, std::size_t side,
                     const float* crops, float pixels_per_crop, std::size_t height,
                     std::size_t width, float* out) {
  constexpr float kUnit = 1.0f / (255 << (2 * kFraction));
  const std::size_t plane = height * width;
  for (std::size_t i = 0; i < images; ++i, windows += side * side * 3, crops += 4) {
    const float scale = crops[2] / pixels_per_crop, c = scale * std::cos(crops[3]),
                s = scale * std::sin(crops[3]);
    for (std::size_t y = 0; y < height; ++y) {
      const float v = static_cast<float>(y) + 0.5f - static_cast<float>(height) / 2;
      for (std::size_t x = 0; x < width; ++x, ++out) {
        const float u = static_cast<float>(x) + 0.5f - static_cast<float>(width) / 2;
        const Place column = place(crops[0] + u * c - v * s - 0.5f, side, 3);
        const Place row = place(crops[1] + u * s + v * c - 0.5f, side, side * 3);
        for (std::size_t channel = 0; channel < 3; ++channel) {
          const std::uint8_t* from = windows + channel;
          const int above =
              between(from[row.near + column.near], from[row.near + column.far], column.share);
          const int below =
              between(from[row.far + column.near], from[row.far + column.far], column.share);
          out[channel * plane] = static_cast<float>(between(above, below, row.share)) * kUnit;
        }
      }
    }
    out += 2 * plane;
  }
}
}
