// RGBA textures with a chain of half-size averages.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace mien::render {

struct Rgba {
  float r, g, b, a;  // 0..255
};

class Texture {
 public:
  Texture(const uint8_t* rgba, int width, int height, bool wrap) : wrap_(wrap) {
    levels_.push_back(
        {width, height, std::vector<uint8_t>(rgba, rgba + size_t(width) * height * 4)});
    while (levels_.back().width > 1 && levels_.back().height > 1)
      levels_.push_back(half(levels_.back()));
  }

  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }

  // Bilinear tap of the level closest to `lod`; v points up.
  Rgba sample(float u, float v, float lod) const {
    const Level& level = levels_[size_t(std::clamp(int(lod + 0.5f), 0, int(levels_.size()) - 1))];
    const float x = u * float(level.width) - 0.5f, y = (1 - v) * float(level.height) - 0.5f;
    const float fx = std::floor(x), fy = std::floor(y);
    const int x0 = address(int(fx), level.width), x1 = address(int(fx) + 1, level.width);
    const int y0 = address(int(fy), level.height), y1 = address(int(fy) + 1, level.height);
    const uint8_t* p[4] = {level.at(x0, y0), level.at(x1, y0), level.at(x0, y1), level.at(x1, y1)};
    const float ax = x - fx, ay = y - fy;
    const float w[4] = {(1 - ax) * (1 - ay), ax * (1 - ay), (1 - ax) * ay, ax * ay};
    float sum[4] = {};
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < 4; ++c) sum[c] += w[k] * float(p[k][c]);
    return {sum[0], sum[1], sum[2], sum[3]};
  }

 private:
  struct Level {
    int width, height;
    std::vector<uint8_t> texels;
    const uint8_t* at(int x, int y) const { return &texels[(size_t(y) * width + x) * 4]; }
  };

  static Level half(const Level& from) {
    Level to{from.width / 2, from.height / 2, {}};
    to.texels.resize(size_t(to.width) * to.height * 4);
    for (int y = 0; y < to.height; ++y)
      for (int x = 0; x < to.width; ++x)
        for (int c = 0; c < 4; ++c)
          to.texels[(size_t(y) * to.width + x) * 4 + c] =
              uint8_t((from.at(2 * x, 2 * y)[c] + from.at(2 * x + 1, 2 * y)[c] +
                       from.at(2 * x, 2 * y + 1)[c] + from.at(2 * x + 1, 2 * y + 1)[c] + 2) /
                      4);
    return to;
  }

  int address(int i, int n) const { return wrap_ ? ((i % n) + n) % n : std::clamp(i, 0, n - 1); }

  bool wrap_;
  std::vector<Level> levels_;
};

}  // namespace mien::render
