// Files of Live Link Face.
#pragma once

#include <string_view>

#include "formats/animation/clip.h"
#include "formats/animation/fault.h"
#include "formats/animation/read_options.h"

namespace mien::formats {

// Columns are found by name, so that older files (camel case, right eye first, BlendShapeCount) are
// read, too. Rows of count 0 may be shorter. Without a timecode, rows are 1/fps apart. What the
// options leave open the whole file has to show, and a note of the clip says what it shows. Angles
// of more than half a turn are a fault.
[[nodiscard]] bool read_live_link_csv(std::string_view text, const ReadOptions& options, Clip& clip,
                                      Fault& fault);

}  // namespace mien::formats
