// Whether a file ends before what its container says that it holds.
#pragma once

#include <string>

namespace mien::app {

// Looks at sizes in the structure of the file: boxes of MP4, the segment of Matroska, chunks of
// AVI, tags of FLV, pages of Ogg, objects of ASF. False for other formats, and where a size is not
// said. Durations and frame rates do not count: they are estimates.
[[nodiscard]] bool ends_early(const std::string& path);

}  // namespace mien::app
