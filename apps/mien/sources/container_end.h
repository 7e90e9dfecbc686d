// Detects files that are shorter than their container declares.
#pragma once

#include <string>

namespace mien::app {

// Compares the size of a file with the sizes in its structure: boxes of MP4, the segment of
// Matroska, chunks of AVI, tags of FLV, pages of Ogg, objects of ASF. Returns false for other
// formats and unspecified sizes. Ignores durations and frame rates, which are estimates.
[[nodiscard]] bool ends_early(const std::string& path);

}  // namespace mien::app
