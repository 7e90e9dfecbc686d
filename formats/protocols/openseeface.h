// OpenSeeFace's packets (facetracker.py), which VSeeFace and others take: UDP port 11573,
// little-endian, 1785 bytes a face.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "formats/animation/clip.h"

namespace mien::formats {

inline constexpr std::size_t kOpenSeeFaceBytes = 1785;

using PicturePoint = std::array<double, 2>;  // x, y in pixels of the upright picture

struct OpenSeeFacePicture {
  double width = 0.0, height = 0.0;        // pixels
  double focal_length_px = 1.0;            // above 0; the principal point is the centre
  std::array<PicturePoint, 68> landmarks;  // iBUG's order (300-W)
  std::array<PicturePoint, 2> pupils;      // right, left
};

// Of a frame with a face: head and position_m count as 0 where they are missing.
//
// Where OpenSeeFace fits a face model into the picture we have a head already. Points in depth are
// where the rays through the landmarks meet the surface of an average head; like OpenSeeFace's own
// they stand in the head, in widths of a face, from the tip of the nose. Its features are relative
// to what a face mostly shows; ours are made of controls. Turn and place are written in the turned
// and mirrored camera space that its receivers undo.
[[nodiscard]] std::string openseeface_packet(const Frame& frame, const OpenSeeFacePicture& picture,
                                             double unix_time_s);

}  // namespace mien::formats
