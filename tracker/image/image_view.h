// A validated view of the caller's image, with upright and unmirrored coordinates.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "tracker/geometry/geometry.h"
#include "tracker/geometry/head_pose.h"

namespace mien::tracker {

// Two images with equal geometry have the same coordinates for the same place.
struct ImageGeometry {
  float width = 0.0f;  // square pixels of the upright image
  float height = 0.0f;
  std::int32_t rotation = 0;
  bool mirrored = false;
  friend bool operator==(const ImageGeometry&, const ImageGeometry&) = default;
};

// The tracker's coordinates are square pixels of the upright scene: rotated by `rotation`,
// stretched by the pixel aspect, and flipped in x if the image is mirrored. No pixel is copied:
// `to_buffer` maps the coordinates to the buffer.
struct ImageView : ImageGeometry {
  mien_image image = {};                 // validated and cropped to the region
  Affine to_buffer;                      // scene -> cropped buffer
  float buffer_pixels_per_pixel = 1.0f;  // along the denser axis
  Rect region;                           // the visible region, in scene coordinates
  Camera camera;                         // in scene coordinates
};

// Validates `given` completely. `horizontal_fov` (radians) applies if it has no focal length.
[[nodiscard]] mien_status view_image(const mien_image* given, float horizontal_fov,
                                     ImageView& view);

// Converts between scene coordinates and the caller's upright image; the map is its own inverse.
[[nodiscard]] inline Point to_upright(const ImageGeometry& view, Point scene) {
  return view.mirrored ? Point{view.width - scene.x, scene.y} : scene;
}

}  // namespace mien::tracker
