// Test images, and the layouts in which cameras deliver them.
#pragma once

#include <mien/mien.h>

#include <cstdint>
#include <vector>

namespace mien::tests {

// An upright, unmirrored RGB image.
class Picture {
 public:
  Picture(int width, int height);  // dark with a weak coloured texture
  // A soft-edged bright disc.
  void disc(float center_x, float center_y, float diameter);
  void grey();                // removes colour
  void noise(unsigned seed);  // replaces everything
  [[nodiscard]] Picture part(int x, int y, int width, int height) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const std::uint8_t* pixel(int x, int y) const {
    return &rgb_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                      static_cast<std::size_t>(x))];
  }

 private:
  [[nodiscard]] std::uint8_t* at(int x, int y) { return const_cast<std::uint8_t*>(pixel(x, y)); }

  int width_;
  int height_;
  std::vector<std::uint8_t> rgb_;
};

struct Layout {
  mien_image_format format = MIEN_IMAGE_RGB;
  int rotation = 0;
  bool mirrored = false;
  bool full_range = true;
  mien_yuv_matrix yuv_matrix = MIEN_YUV_BT601;
  int row_padding_bytes = 0;
  bool bottom_up = false;
  int chroma_pixel_stride = 1;  // I420
};

// The scene in the given layout; `image()` describes it.
class Buffer {
 public:
  Buffer(const Picture& scene, const Layout& layout);
  [[nodiscard]] const mien_image& image() const { return image_; }

 private:
  void add_plane(int plane, int row_bytes, int rows, const Layout& layout);
  std::uint8_t* at(int plane, int x_bytes, int y);

  std::vector<std::uint8_t> planes_[3];
  mien_image image_;
};

}  // namespace mien::tests
