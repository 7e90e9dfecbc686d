// Options for readers: data that files do not contain, and a loader for other files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "apps/animation/live_link_csv.h"

namespace mien::animation {

// Unit of positions in BVH files.
enum class LengthUnit : std::uint8_t { kMetres, kCentimetres, kMillimetres, kInches };
[[nodiscard]] double metres(LengthUnit unit);
[[nodiscard]] const char* name(LengthUnit unit);  // "metres", ... Static.

// Reads the first `bytes` bytes of a file beside the one that refers to it. Returns false with the
// reason on failure.
using LoadBeside = std::function<bool(const std::string& name, std::size_t bytes, std::string& data,
                                      std::string& why)>;

struct ReadOptions {
  // Live Link Face; default: detected.
  std::optional<RotationUnit> rotation;
  std::optional<double> timecode_fps;  // 1..100
  // BVH; default: detected from the size of the skeleton.
  std::optional<LengthUnit> bvh_unit;
  // Buffers of glTF; empty: buffers in other files are rejected.
  LoadBeside load_beside;
};

}  // namespace mien::animation
