// A recording as a page in a browser wants it.
#pragma once

#include <optional>
#include <string>

#include "apps/mien/outputs/output_file.h"

namespace mien::app {

struct WebVideo {
  std::string picture;          // file; empty: none
  std::string sound;            // file; empty, or without sound: none
  int audio_track = 1;          // of `sound`; the first is 1
  std::optional<int> rotation;  // degrees clockwise, instead of what the file says
  double start_s = 0.0, duration_s = 0.0;
};

// H.264 in MP4, at most 640 square pixels a side, with sound, its own frame times, and a key frame
// a second to seek to. Made by ffmpeg, which leaves it in `file`, too. Throws Failure.
std::string web_video(const WebVideo& wanted, const PartialFile& file);

}  // namespace mien::app
