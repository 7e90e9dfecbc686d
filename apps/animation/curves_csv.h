// Curves as CSV, one row per frame; docs/cli.md describes the columns.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "apps/animation/clip.h"
#include "apps/animation/fault.h"
#include "apps/animation/writer.h"

namespace mien::animation {

// The vocabulary of the last columns: the 52 controls, Roblox's 50 units or the 6 of its level of
// detail 1, or the 15 visemes. The columns before them are the same.
enum class Weights : std::uint8_t { kControls, kFacs, kFacsLevel1, kVisemes };

// `several_faces` adds the column face_id; each face of a frame has a row.
[[nodiscard]] std::unique_ptr<AnimationWriter> curves_csv_writer(Weights weights,
                                                                 bool several_faces);

// The vocabulary with the most columns decides the content of the file; controls are derived from
// units and visemes. Columns are matched by name in any order; unknown ones are ignored. t_ms and
// one weight are required. Leaves `clip` unchanged on failure.
[[nodiscard]] bool read_curves_csv(std::string_view text, Clip& clip, Fault& fault);

}  // namespace mien::animation
