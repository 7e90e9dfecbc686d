// Packets of OpenSeeFace (facetracker.py), which VSeeFace and others receive: UDP port 11573,
// little-endian, 1785 bytes per face.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "apps/animation/clip.h"

namespace mien::protocols {

inline constexpr std::size_t kOpenSeeFaceBytes = 1785;

using ImagePoint = std::array<double, 2>;  // x, y in pixels of the upright image

struct OpenSeeFaceImage {
  double width = 0.0, height = 0.0;      // pixels
  double focal_length_px = 1.0;          // above 0; the principal point is the centre
  std::array<ImagePoint, 68> landmarks;  // iBUG's order (300-W)
  std::array<ImagePoint, 2> pupils;      // right, left
};

// Requires a frame with a face; missing head and position_m count as 0.
//
// OpenSeeFace fits a face model to the image, but here the head pose is known. 3D points are
// intersections of the rays through the landmarks with the surface of an average head. As in
// OpenSeeFace, they are in head space, in units of the face width, relative to the tip of the nose.
// OpenSeeFace's features are relative to a person's typical values; ours are derived from controls.
// Rotation and position use the rotated and mirrored camera space that receivers undo.
[[nodiscard]] std::string openseeface_packet(const animation::Frame& frame,
                                             const OpenSeeFaceImage& image, double unix_time_s);

}  // namespace mien::protocols
