// Curves as CSV: a row a frame; docs/cli.md describes the columns.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "formats/animation/clip.h"
#include "formats/animation/fault.h"
#include "formats/animation/writer.h"

namespace mien::formats {

// What the last columns are: the 52 controls, Roblox's 50 units or the 6 of its level of detail 1,
// the 15 visemes. The columns before them are the same for all.
enum class Weights : std::uint8_t { kControls, kFacs, kFacsLevel1, kVisemes };

// `several_faces`: a column more, face_id, and a row for each face of a frame.
[[nodiscard]] std::unique_ptr<AnimationWriter> curves_csv_writer(Weights weights,
                                                                 bool several_faces);

// Which of the vocabularies most columns of the header belong to tells what the file holds; of
// units and visemes the controls are made. Columns are found by their names, in any order; others
// are passed over. t_ms and one weight have to be there. On a fault `clip` stays as it was.
[[nodiscard]] bool read_curves_csv(std::string_view text, Clip& clip, Fault& fault);

}  // namespace mien::formats
