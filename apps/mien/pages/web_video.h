// A recording as a page in a browser wants it.
#pragma once

#include <string>

namespace mien::app {

struct WebVideo {
  std::string picture;  // file; empty: none
  std::string sound;    // file; empty, or without sound: none
  double start_s = 0.0, duration_s = 0.0;
};

// H.264 in MP4, at most 640 pixels a side, with sound, its own frame times, and a key frame a
// second to seek to. Made by ffmpeg by way of a file named `scratch`, which is gone again
// afterwards. Throws Failure.
std::string web_video(const WebVideo& wanted, const std::string& scratch);

}  // namespace mien::app
