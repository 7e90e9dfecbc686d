// Encodes video files with the ffmpeg program.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/mien/outputs/output_file.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/system/subprocess.h"

namespace mien::app {

// Encodes RGB frames of one size as H.264 (or the format of the name's ending), with the audio of
// `audio_from` if it has any. The file appears under its name only when `finish` succeeds.
class VideoEncoder {
 public:
  VideoEncoder(const std::string& path, int width, int height, double fps,
               const std::string& audio_from, int audio_track, const VideoRange& range);
  // `rgb` has width * height * 3 bytes; `time_ns` is its timestamp. The video has a constant frame
  // rate: images are repeated or dropped to stay in sync with the audio.
  void write(const std::vector<unsigned char>& rgb, std::int64_t time_ns);
  void finish();

 private:
  [[noreturn]] void fail();

  void send();

  std::string path_;
  double fps_;
  double start_s_;
  std::int64_t frames_ = 0;                // written
  std::vector<unsigned char> last_image_;  // the latest image
  PartialFile
      partial_;  // declared before the encoder, so that it is removed after ffmpeg has ended
  Subprocess encoder_;
};

}  // namespace mien::app
