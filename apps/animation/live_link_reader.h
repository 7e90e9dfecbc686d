// Reads files of Live Link Face.
#pragma once

#include <string_view>

#include "apps/animation/clip.h"
#include "apps/animation/fault.h"
#include "apps/animation/read_options.h"

namespace mien::animation {

// Columns are found by name, so older files (camel case, right eye first, BlendShapeCount) are
// accepted. Rows with count 0 may be shorter. Without a timecode, rows are 1/fps apart. Units that
// the options leave open are detected from the whole file, and a note names them. Angles above half
// a turn are an error.
[[nodiscard]] bool read_live_link_csv(std::string_view text, const ReadOptions& options, Clip& clip,
                                      Fault& fault);

}  // namespace mien::animation
