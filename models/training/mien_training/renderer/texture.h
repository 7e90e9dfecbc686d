// RGBA textures with a chain of half-size averages.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace mien::render {

using Rgba = float __attribute__((vector_size(16)));  // 0..255

// Logarithm to the base of 2 of a positive number, within 0.01.
inline float fast_log2(float x) {
  const uint32_t bits = std::bit_cast<uint32_t>(x);
  const float m = std::bit_cast<float>((bits & 0x007fffffu) | 0x3f800000u);  // 1..2
  return float(int(bits >> 23) - 127) + (m - 1) * (1.3465f - 0.3465f * (m - 1));
}

class Texture {
 public:
  Texture(const uint8_t* rgba, int width, int height, bool wrap)
      : wrap_(wrap), detail_(0.5f * std::log2(float(width) * float(height)) - 0.3f) {
    levels_.push_back(
        {width, height, std::vector<uint8_t>(rgba, rgba + size_t(width) * height * 4)});
    while (levels_.back().width > 1 && levels_.back().height > 1)
      levels_.push_back(half(levels_.back()));
  }

  // Half of the log of the number of texels, less 0.3.
  float detail() const { return detail_; }

  // Bilinear tap of the level closest to `lod`; v points up.
  Rgba sample(float u, float v, float lod) const {
    const Level& level = levels_[size_t(std::clamp(int(lod + 0.5f), 0, int(levels_.size()) - 1))];
    const float x = u * float(level.width) - 0.5f, y = (1 - v) * float(level.height) - 0.5f;
    const float fx = std::floor(x), fy = std::floor(y);
    const int x0 = address(int(fx), level.width), x1 = address(int(fx) + 1, level.width);
    const int y0 = address(int(fy), level.height), y1 = address(int(fy) + 1, level.height);
    const float ax = x - fx, ay = y - fy;
    return (level.at(x0, y0) * (1 - ax) + level.at(x1, y0) * ax) * (1 - ay) +
           (level.at(x0, y1) * (1 - ax) + level.at(x1, y1) * ax) * ay;
  }

  // The nearest texel of that level alone, one channel.
  float nearest(float u, float v, float lod, int channel) const {
    const Level& level = levels_[size_t(std::clamp(int(lod + 0.5f), 0, int(levels_.size()) - 1))];
    const int x = address(int(std::floor(u * float(level.width))), level.width);
    const int y = address(int(std::floor((1 - v) * float(level.height))), level.height);
    return float(level.texel(x, y)[channel]);
  }

 private:
  struct Level {
    int width, height;
    std::vector<uint8_t> texels;
    Rgba at(int x, int y) const {
      uint8_t __attribute__((vector_size(4))) bytes;
      std::memcpy(&bytes, texel(x, y), sizeof bytes);
      return __builtin_convertvector(bytes, Rgba);
    }
    const uint8_t* texel(int x, int y) const { return &texels[(size_t(y) * width + x) * 4]; }
  };

  static Level half(const Level& from) {
    Level to{from.width / 2, from.height / 2, {}};
    to.texels.resize(size_t(to.width) * to.height * 4);
    for (int y = 0; y < to.height; ++y)
      for (int x = 0; x < to.width; ++x)
        for (int c = 0; c < 4; ++c)
          to.texels[(size_t(y) * to.width + x) * 4 + c] =
              uint8_t((from.texel(2 * x, 2 * y)[c] + from.texel(2 * x + 1, 2 * y)[c] +
                       from.texel(2 * x, 2 * y + 1)[c] + from.texel(2 * x + 1, 2 * y + 1)[c] + 2) /
                      4);
    return to;
  }

  int address(int i, int n) const {
    if (unsigned(i) < unsigned(n)) return i;
    return wrap_ ? ((i % n) + n) % n : std::clamp(i, 0, n - 1);
  }

  bool wrap_;
  float detail_;
  std::vector<Level> levels_;
};

}  // namespace mien::render
