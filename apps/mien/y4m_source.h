// Uncompressed YUV4MPEG2 video from a file or standard input, without ffmpeg.
#pragma once

#include <memory>
#include <string>

#include "apps/mien/video_source.h"

namespace mien::app {

std::unique_ptr<VideoSource> open_y4m(const std::string& input, const VideoRange& range);

}  // namespace mien::app
