// Uncompressed YUV4MPEG2 video from a file or standard input, without ffmpeg.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "apps/mien/sources/video_source.h"
#include "formats/y4m.h"

namespace mien::app {

[[nodiscard]] bool is_y4m(const std::string& input);  // by its name; "-" is standard input

// The reason why only ffmpeg can read a Y4M file, or "" if this program can. Throws Failure if the
// file does not exist.
[[nodiscard]] std::string y4m_refusal(const std::string& path);

// An image that refers to the pixels of a frame with this header.
mien_image y4m_image(const formats::Y4mHeader& header, const std::byte* frame);

std::unique_ptr<VideoSource> open_y4m(const std::string& input, const InputOptions& options);

}  // namespace mien::app
