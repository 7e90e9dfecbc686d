// An RGB image to draw on.
#pragma once

#include <mien/mien.h>

#include <string>
#include <vector>

namespace mien::app {

struct Color {
  unsigned char r, g, b;
};

class Canvas {
 public:
  Canvas(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<unsigned char>& rgb() const { return rgb_; }

  // Copies an RGB, I420 or grey image to the top left corner, rotated upright (mien_image.rotation)
  // and scaled to width x height pixels.
  void paste(const mien_image& image, int width, int height);
  void fill(int x, int y, int width, int height, Color color);
  void dot(float x, float y, float radius, Color color);
  void line(float x0, float y0, float x1, float y1, Color color);
  void text(int x, int y, const std::string& text, Color color);  // ASCII, 7 pixels high

 private:
  void set(int x, int y, Color color);

  int width_;
  int height_;
  std::vector<unsigned char> rgb_;  // [height][width][3]
};

}  // namespace mien::app
