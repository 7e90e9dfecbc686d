// Draws results over and beside an image.
#pragma once

#include <mien/mien.hpp>

#include <span>

#include "apps/mien/outputs/canvas.h"

namespace mien::app {

class Overlay {
 public:
  // The size of the images; small ones are enlarged.
  Overlay(int width, int height);
  int width() const { return canvas_.width(); }
  int height() const { return canvas_.height(); }
  // Draws all faces, and the controls of the first.
  const Canvas& draw(const mien_image& image, std::span<const Result> faces);

 private:
  void draw_face(const Result& result);
  void draw_pose(const Result& result);
  void draw_controls(const Result& result);

  int width_, height_;  // of the upright image
  int scale_;
  int panel_x_;
  Canvas canvas_;
};

}  // namespace mien::app
