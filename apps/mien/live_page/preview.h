// A small copy of an image for a browser.
#pragma once

#include <mien/mien.h>

#include <string>

namespace mien::app {

inline constexpr int kPreviewSide = 320;  // of the longer side, pixels

// A BMP file with square pixels, 24 bits each; the image is not rotated. BMP needs no encoder, and
// all browsers decode it. Accepts the formats of video sources: RGB, I420, GRAY8.
[[nodiscard]] std::string preview_of(const mien_image& image);

}  // namespace mien::app
