#include "apps/mien/sources/video_source.h"

#include "apps/mien/sources/ffmpeg.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/sources/y4m_source.h"

namespace mien::app {

bool is_y4m(const std::string& input) {
  return input == "-" || (input.ends_with(".y4m") && !is_url(input));
}

std::unique_ptr<VideoSource> open_video(const std::string& input, const VideoRange& range) {
  if (is_y4m(input)) {
    return open_y4m(input, range);
  }
  return open_with_ffmpeg(input, range);
}

}  // namespace mien::app
