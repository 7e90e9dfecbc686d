// glTF 2.0 animation of morph weights, head and eyes, as .glb or as .gltf with its data inside.
//
// Nodes: root > head > leftEye, rightEye, face; the mesh of `face` is one small triangle with 52
// morph targets that move nothing, so that a program for animation shows 52 named curves
// (mesh.extras.targetNames). Keys lie at the frames, seconds from the first; a frame at the same
// time as the one before, as fp32 has it, is left out. Head and eyes have keys where there is a
// head, or eyes. animation.extras.mien says what glTF has no word for: start_ns, the time of the
// first frame; states, a letter (s, t, l) a frame; not_driven, the controls that nothing drives.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "formats/animation/clip.h"
#include "formats/animation/fault.h"
#include "formats/animation/read_options.h"
#include "formats/animation/writer.h"

namespace mien::formats {

enum class GltfForm : std::uint8_t { kText, kBinary };

[[nodiscard]] std::unique_ptr<AnimationWriter> gltf_writer(GltfForm form);

// The first animation: weights of a mesh whose target names are ARKit's (mouthSmileLeft or
// mouthSmile_L), rotation and translation of nodes called head, leftEye, rightEye. Frames are
// where the weights have keys, or the head without any. Values are fp32 or normalized whole
// numbers, their buffers in the file or beside it (options.load_beside). Weights beyond 0..1 are
// brought there. Only what is animated is looked at: textures and meshes may be compressed, values
// of the animation not. On a fault `clip` stays as it was.
[[nodiscard]] bool read_gltf(std::string_view bytes, const ReadOptions& options, Clip& clip,
                             Fault& fault);

}  // namespace mien::formats
