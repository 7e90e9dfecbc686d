// Video files, through the ffmpeg program.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/mien/outputs/output_file.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/system/subprocess.h"

namespace mien::app {

// Encodes RGB frames of one size as H.264 (or what the name's ending asks for), with the sound of
// `audio_from` when that has any. The file appears under its name only when `finish` succeeds.
class VideoEncoder {
 public:
  VideoEncoder(const std::string& path, int width, int height, double fps,
               const std::string& audio_from, int audio_track, const VideoRange& range);
  // Width * height * 3 bytes, and when it is shown. The video has a constant frame rate: pictures
  // are repeated or left out, so that they stay beside the sound.
  void write(const std::vector<unsigned char>& rgb, std::int64_t time_ns);
  void finish();

 private:
  [[noreturn]] void fail();

  void send();

  std::string path_;
  double fps_;
  double start_s_;
  std::int64_t frames_ = 0;           // written
  std::vector<unsigned char> shown_;  // since the last that was written
  PartialFile partial_;               // before what writes it, and so removed when that has ended
  Subprocess encoder_;
};

}  // namespace mien::app
