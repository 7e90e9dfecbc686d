// A copy of an image.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <vector>

namespace mien::app {

class HeldImage {
 public:
  // Copies the pixels of an image in one of the formats of video sources: grey, RGB, I420.
  explicit HeldImage(const mien_image& image);
  HeldImage(HeldImage&&) = default;
  HeldImage& operator=(HeldImage&&) = default;

  [[nodiscard]] const mien_image& image() const { return image_; }
  [[nodiscard]] std::size_t bytes() const { return pixels_.size(); }

 private:
  std::vector<std::byte> pixels_;
  mien_image image_;  // its planes lie in `pixels_`
};

}  // namespace mien::app
