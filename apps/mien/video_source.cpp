#include "apps/mien/video_source.h"

#include "apps/mien/ffmpeg.h"
#include "apps/mien/y4m_source.h"

namespace mien::app {

bool is_y4m(const std::string& input) { return input == "-" || input.ends_with(".y4m"); }

std::unique_ptr<VideoSource> open_video(const std::string& input, const VideoRange& range) {
  if (is_y4m(input)) {
    return open_y4m(input, range);
  }
  return open_with_ffmpeg(input, range);
}

}  // namespace mien::app
