// What files do not say of themselves, and where to find what lies beside them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "formats/animation/live_link_csv.h"

namespace mien::formats {

// Of positions in BVH files.
enum class LengthUnit : std::uint8_t { kMetres, kCentimetres, kMillimetres, kInches };
[[nodiscard]] double metres(LengthUnit unit);
[[nodiscard]] const char* name(LengthUnit unit);  // "metres", ... Static.

// Reads the first `bytes` bytes of a file beside the one that names it. False, with the reason,
// where that cannot be done.
using LoadBeside = std::function<bool(const std::string& name, std::size_t bytes, std::string& data,
                                      std::string& why)>;

struct ReadOptions {
  // Of Live Link Face; nothing: as the file shows it.
  std::optional<RotationUnit> rotation;
  std::optional<double> timecode_fps;  // 1..100
  // Of BVH; nothing: as the size of the skeleton shows it.
  std::optional<LengthUnit> bvh_unit;
  // For buffers of glTF; none: buffers in other files are refused.
  LoadBeside load_beside;
};

}  // namespace mien::formats
