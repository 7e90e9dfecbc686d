// Uncompressed YUV4MPEG2 video from a file or standard input, without ffmpeg.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "apps/mien/sources/video_source.h"
#include "formats/y4m.h"

namespace mien::app {

[[nodiscard]] bool is_y4m(const std::string& input);  // by its name; "-" is standard input

// Why a Y4M file cannot be read without ffmpeg; empty where it can. Throws Failure where there is
// no such file.
[[nodiscard]] std::string y4m_refusal(const std::string& path);

// The frame that a reader with this header has read, which the image points into.
mien_image y4m_image(const formats::Y4mHeader& header, const std::byte* frame);

std::unique_ptr<VideoSource> open_y4m(const std::string& input, const InputOptions& options);

}  // namespace mien::app
