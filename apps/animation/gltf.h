// glTF 2.0 animation of morph weights, head and eyes, as .glb or as .gltf with embedded data.
//
// Nodes: root > head > leftEye, rightEye, face; root > body, which follows the position of the
// head. Their meshes are the avatar of the pages; that of `face` has 52 morph targets
// (mesh.extras.targetNames).
// Keys are at the frames, in seconds from the first; a frame whose fp32 time equals the previous
// one is omitted. Head and eyes have keys for frames that have them. animation.extras.mien has data
// without a place in glTF: start_ns, the time of the first frame; states, one letter (s, t, l) per
// frame; not_driven, the unsupported controls.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "apps/animation/clip.h"
#include "apps/animation/fault.h"
#include "apps/animation/read_options.h"
#include "apps/animation/writer.h"

namespace mien::animation {

enum class GltfForm : std::uint8_t { kText, kBinary };

[[nodiscard]] std::unique_ptr<AnimationWriter> gltf_writer(GltfForm form);

// Reads the first animation: weights of a mesh whose targets have ARKit's names (mouthSmileLeft or
// mouthSmile_L), and rotation and translation of nodes called head, leftEye, rightEye. Frames are
// at the keys of the weights, or of the head if there are no weights. Values are fp32 or normalized
// integers, in the file or beside it (options.load_beside). Clamps weights to 0..1. Reads animated
// data only, so textures and meshes may be compressed, but not the values of the animation. Leaves
// `clip` unchanged on failure.
[[nodiscard]] bool read_gltf(std::string_view bytes, const ReadOptions& options, Clip& clip,
                             Fault& fault);

}  // namespace mien::animation
