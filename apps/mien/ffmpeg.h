// Video through the ffmpeg and ffprobe programs: nothing of them is linked.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/mien/subprocess.h"
#include "apps/mien/video_source.h"

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

// The line of what ffmpeg said on stderr that tells why it stopped.
std::string last_line(const std::string& text);

// Any file ffmpeg can decode, upright (display rotation applied), RGB, at its own frame times.
std::unique_ptr<VideoSource> open_with_ffmpeg(const std::string& input, const VideoRange& range);

// Encodes RGB frames of one size as H.264 (or what the name's ending asks for), with the sound of
// `sound_from` when that has any. The file appears under its name only when `finish` succeeds.
class VideoEncoder {
 public:
  VideoEncoder(const std::string& path, int width, int height, double fps,
               const std::string& sound_from, const VideoRange& range);
  ~VideoEncoder();
  void write(const std::vector<unsigned char>& rgb);  // width * height * 3 bytes
  void finish();

 private:
  [[noreturn]] void fail();

  std::string path_;
  std::string partial_path_;
  Subprocess encoder_;
};

}  // namespace mien::app
