// Video files, through the ffmpeg program.
#pragma once

#include <string>
#include <vector>

#include "apps/mien/outputs/output_file.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/system/subprocess.h"

namespace mien::app {

// Encodes RGB frames of one size as H.264 (or what the name's ending asks for), with the sound of
// `sound_from` when that has any. The file appears under its name only when `finish` succeeds.
class VideoEncoder {
 public:
  VideoEncoder(const std::string& path, int width, int height, double fps,
               const std::string& sound_from, const VideoRange& range);
  void write(const std::vector<unsigned char>& rgb);  // width * height * 3 bytes
  void finish();

 private:
  [[noreturn]] void fail();

  std::string path_;
  PartialFile partial_;  // before what writes it, and so removed when that has ended
  Subprocess encoder_;
};

}  // namespace mien::app
