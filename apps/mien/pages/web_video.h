// Transcodes a recording for a page in a browser.
#pragma once

#include <optional>
#include <string>

#include "apps/mien/outputs/output_file.h"

namespace mien::app {

struct WebVideo {
  std::string video;            // file; empty: none
  std::string audio;            // file; empty, or a file without audio: none
  int audio_track = 1;          // of `sound`; the first is 1
  std::optional<int> rotation;  // degrees clockwise; overrides the file
  double start_s = 0.0, duration_s = 0.0;
};

// H.264 in MP4 with at most 640 square pixels per side, with audio, the original timestamps, and a
// keyframe per second for seeking. ffmpeg writes it to `file`; returns its content. Throws Failure.
std::string web_video(const WebVideo& request, const PartialFile& file);

}  // namespace mien::app
