// The avatar of the pages as meshes with one morph target per control, for glTF.
//
// apps/web/avatar/bake.mjs writes it; the program contains it packed (docs/format.md). The content
// is a sequence of integers, each 2 |v| or, if negative, 2 |v| - 1, as a varint (7 bits per byte,
// the lowest first):
//
// - number of parts;
//
// - of each part: node, rows, columns, flags (1 columns closed, 2 triangles seen from the other
//   side, 4 rows closed, 8 x how columns mirror: 0 same, 1 around a closed ring, 2 reversed), and
//   the distance to its mirrored part;
//
// - positions in 1/1024 of half the width of the head: x of all vertices, then y, then z;
//
// - colours, 0..255, in the same order;
//
// - offsets of the 52 targets in 1/512, in the same order; those of the right side minus the
//   mirrored ones of the left side.
//
// Values on the grid of a part are stored as differences from a prediction: the left neighbour plus
// the one below, minus the one below on the left.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "formats/vocabulary/vocabulary.h"

namespace mien::animation {

using Vector = std::array<float, 3>;

// Lengths are in metres.
struct AvatarMesh {
  std::vector<Vector> positions, normals;
  std::vector<std::array<std::uint8_t, 4>> colors;  // linear
  std::vector<std::uint16_t> triangles;
};

struct AvatarModel {
  AvatarMesh face, body, eye;  // of head space; the eye is around its centre
  std::array<Vector, 2> eye_centres;
  std::array<std::vector<Vector>, formats::kControlCount> targets;  // offsets of face.positions
};

[[nodiscard]] AvatarModel avatar_model();

}  // namespace mien::animation
