// Video through the ffmpeg and ffprobe programs: nothing of them is linked.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/mien/sources/video_source.h"

namespace mien::app {

// What there is in an input; "-" and Y4M are video alone, WAV is sound alone.
struct InputStreams {
  bool video = false;  // a picture on the sleeve is none
  bool sound = false;
};

// Throws Failure when there is no such file, or nothing of either in it.
InputStreams probe_streams(const std::string& input);

// What a file says of its video. Throws Failure when there is no such file, or no video in it.
VideoInfo probe_video(const std::string& input);

// What ffmpeg is told to write a file by: whatever its name holds, it names a file and no protocol
// or option. For inputs: input_arguments.
std::string output_file(const std::string& path);

// The line of what ffmpeg said on stderr that tells why it stopped.
std::string last_line(const std::string& text);

// Any file ffmpeg can decode, upright (display rotation applied), RGB, at its own frame times.
std::unique_ptr<VideoSource> open_with_ffmpeg(const std::string& input, const VideoRange& range);

}  // namespace mien::app
