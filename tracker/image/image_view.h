// The caller's image as the tracker sees it: upright and un-mirrored, whatever lies in memory.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "tracker/geometry/geometry.h"
#include "tracker/geometry/head_pose.h"

namespace mien::tracker {

// What has to be the same for a point of one image to mean the same place in another.
struct ImageGeometry {
  float width = 0.0f;  // square pixels of the upright image
  float height = 0.0f;
  std::int32_t rotation = 0;
  bool mirrored = false;
  friend bool operator==(const ImageGeometry&, const ImageGeometry&) = default;
};

// Coordinates of the tracker are square pixels of the upright scene: turned by `rotation`,
// stretched by the pixel aspect, and flipped sideways when the picture is mirrored. No pixel is
// moved: `to_buffer` tells where each one lies.
struct ImageView : ImageGeometry {
  mien_image image = {};  // every plane, stride and dimension checked; cut down to the region
  Affine to_buffer;       // scene -> what is left of the buffer
  float buffer_pixels_per_pixel = 1.0f;  // along the axis where they are most
  Rect region;                           // in the scene's coordinates: what there is to see
  Camera camera;                         // in the scene's coordinates
};

// Checks `given` completely. `horizontal_fov` (radians) is used where it has no focal length.
[[nodiscard]] mien_status view_image(const mien_image* given, float horizontal_fov,
                                     ImageView& view);

// Between the scene's coordinates and those of the upright picture as the caller sees it.
[[nodiscard]] inline Point to_picture(const ImageGeometry& view, Point scene) {
  return view.mirrored ? Point{view.width - scene.x, scene.y} : scene;
}

}  // namespace mien::tracker
