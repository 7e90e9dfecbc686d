// A video as a page in a browser wants it.
#pragma once

#include <string>

namespace mien::app {

// From `start_s` on, `duration_s` at most: H.264 in MP4, at most 640 pixels a side, with its sound,
// its own frame times, and a key frame a second to seek to. Made by ffmpeg by way of a file named
// `scratch`, which is gone again afterwards. Throws Failure.
std::string web_video(const std::string& input, double start_s, double duration_s,
                      const std::string& scratch);

}  // namespace mien::app
